"""How turtlesim_node ends while it publishes, and its window without Tk; needs no master."""

import runpy
import sys
from pathlib import Path

import pytest
import rospy
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
