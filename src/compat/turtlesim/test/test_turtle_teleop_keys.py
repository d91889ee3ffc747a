"""What turtle_teleop_key makes of typed characters; needs no master."""

import pytest
from turtlesim.teleop_keys import TEXT, drive, split_keys

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
