"""Events of a joystick whose meaning is known."""

import pytest
from joy.events import AXIS, BUTTON, EVENT, INITIAL, Stick, events_in, usable_deadzone


def test_axes_reach_one_and_count_left_and_up_as_positive():
    stick = Stick(deadzone=0.0)
    for number, value in enumerate((32767, -32767, -32768, 0)):
        assert not stick.take(value, AXIS, number)
    assert stick.axes == [-1.0, 1.0, 1.0, 0.0]


def test_deadzone_is_zero_and_what_lies_beyond_starts_there():
    stick = Stick(deadzone=0.5)
    stick.take(16383, AXIS, 0)
    assert stick.axes == [0.0]
    stick.take(-round(32767 * 0.75), AXIS, 0)
    assert stick.axes == pytest.approx([0.5], abs=1e-4)


def test_triggers_at_the_start():
    untouched, as_is = Stick(), Stick(default_trig_val=True)
    for stick in (untouched, as_is):
        stick.take(-32767, AXIS | INITIAL, 2)
    assert (untouched.axes, as_is.axes) == ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0])


def test_buttons_and_sticky_ones():
    plain, sticky = Stick(), Stick(sticky_buttons=True)
    seen = []
    for value in (1, 0, 1, 0):
        assert plain.take(value, BUTTON, 1) and sticky.take(value, BUTTON, 1)
        seen.append((plain.buttons[1], sticky.buttons[1]))
    assert seen == [(1, 1), (0, 1), (1, 0), (0, 0)]


def test_bytes():
    data = EVENT.pack(5, -7, AXIS, 3) + EVENT.pack(6, 1, BUTTON, 0) + b"half"
    assert list(events_in(data)) == [(-7, AXIS, 3), (1, BUTTON, 0)]


@pytest.mark.parametrize("told, used", [(0.3, 0.3), (-1.0, 0.0), (0.95, 0.9), (32767 / 4, 0.25)])
def test_deadzones_of_all_ages(told, used):
    assert usable_deadzone(told) == pytest.approx(used)
