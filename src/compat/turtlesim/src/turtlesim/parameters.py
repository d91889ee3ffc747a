"""The private parameters background_r, _g and _b."""

from __future__ import annotations

import rospy

from turtlesim.pond.canvas import Color
from turtlesim.pond.pond import BACKGROUND

_NAMES = ("~background_r", "~background_g", "~background_b")


def declare_background() -> None:
    """Put what is not set on the server, so that `rosparam list` shows it."""
    for name, default in zip(_NAMES, BACKGROUND):
        if not rospy.has_param(name):
            rospy.set_param(name, default)


def read_background() -> Color:
    """A value that is no colour counts as not set, with one warning."""
    red, green, blue = (_read(name, default) for name, default in zip(_NAMES, BACKGROUND))
    return red, green, blue


def _read(name: str, default: int) -> int:
    value = rospy.get_param(name, default)
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 255:
        return value
    rospy.logwarn("parameter %s must be a whole number from 0 to 255, not %r: %d is used",
                  rospy.resolve_name(name), value, default)
    return default
