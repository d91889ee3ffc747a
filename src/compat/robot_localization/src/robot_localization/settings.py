"""The node's parameters, each with its name in what is said of a wrong one."""

import rospy

from robot_localization.filtering.measurements import BadConfig


def number(name, default):
    """Raises BadConfig if it is none."""
    value = rospy.get_param(f"~{name}", default)
    try:
        return float(value)
    except (TypeError, ValueError):
        raise BadConfig(f"{name} is {value!r}; it has to be a number") from None


def frame(name, default):
    """Without the slash that tf had before it."""
    return str(rospy.get_param(f"~{name}", default)).lstrip("/")
