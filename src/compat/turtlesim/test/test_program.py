"""Programs without a master: how turtlesim_node ends, its window without Tk, the typed keys."""

import runpy
import sys
from pathlib import Path

import pytest
import rospy
from turtlesim.teleop_keys import TEXT, drive, split_keys
from turtlesim.window import NoScreen, Window

PROGRAM = Path(__file__).resolve().parents[1] / "nodes" / "turtlesim_node"


def closed(*_args, **_kwargs):
    raise rospy.ROSException("publish() to a closed topic")


@pytest.mark.parametrize("ending", [True, False])
def test_closed_topics_are_a_fault_only_while_it_runs(monkeypatch, ending):
    monkeypatch.setattr(rospy, "init_node", closed)
    monkeypatch.setattr(rospy, "is_shutdown", lambda: ending)
    if ending:  # another node has taken its name
        runpy.run_path(str(PROGRAM), run_name="__main__")
    else:
        with pytest.raises(rospy.ROSException, match="closed topic"):
            runpy.run_path(str(PROGRAM), run_name="__main__")


def test_without_tk_it_is_said_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "tkinter", None)  # importing it is an ImportError now
    with pytest.raises(NoScreen, match="sudo apt-get install python3-tk"):
        Window()


UP, DOWN, RIGHT, LEFT = (f"\x1b[{letter}" for letter in "ABCD")


def moves(typed):
    keys, _ = split_keys(typed)
    return [drive(key) for key in keys]


@pytest.mark.parametrize("key, move", [
    (UP, (1, 0)), (DOWN, (-1, 0)), (LEFT, (0, 1)), (RIGHT, (0, -1)), ("\x1bOA", (1, 0)),
])
def test_arrows(key, move):
    assert moves(key) == [move]


@pytest.mark.parametrize("typed", ["A", "w", "g", "\x1b[H", "\x1b[3~", "\x1b[15~", "中", "\n"])
def test_other_keys_move_nothing(typed):
    assert moves(typed) == [None]


def test_keys_typed_at_once_are_told_apart():
    assert moves(UP + LEFT + "x" + DOWN) == [(1, 0), (0, 1), None, (-1, 0)]


@pytest.mark.parametrize("cut", [1, 2])
def test_an_arrow_may_come_in_parts(cut):
    keys, rest = split_keys("q" + UP[:cut])
    assert (keys, rest) == (["q"], UP[:cut])
    assert split_keys(rest + UP[cut:]) == (["\x1bA"], "")


def test_the_text_is_upstreams():
    assert TEXT.splitlines()[0] == "Reading from keyboard"
    assert TEXT.splitlines()[2] == "Use arrow keys to move the turtle. 'q' to quit."
