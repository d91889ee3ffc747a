"""Markers dragged to known places."""

import math

import pytest
from interactive_marker_twist_server.dragging import Drag, read_axes

STRAIGHT = (0.0, 0.0, 0.0, 1.0)


def test_upstreams_defaults():
    assert Drag().velocity((0.5, 3.0, 3.0), STRAIGHT) == ((0.5, 0.0, 0.0), 0.0)
    assert Drag().velocity((4.0, 0.0, 0.0), STRAIGHT)[0][0] == 1.0
    assert Drag().velocity((-4.0, 0.0, 0.0), STRAIGHT)[0][0] == -1.0


@pytest.mark.parametrize("yaw, rate", [(0.5, 1.1), (-0.5, -1.1), (3.0, 2.2), (-3.0, -2.2)])
def test_turning(yaw, rate):
    turned = (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
    assert Drag().velocity((0.0, 0.0, 0.0), turned)[1] == pytest.approx(rate)


def test_each_axis_has_its_scale_and_limits():
    drag = Drag({"x": 2.0, "y": 1.0, "z": 1.0}, {"x": 9.0, "y": 0.2}, {"x": -1.0, "y": -0.1})
    assert drag.velocity((1.0, 1.0, 5.0), STRAIGHT)[0] == (2.0, 0.2, 5.0)
    assert drag.velocity((-1.0, -1.0, -5.0), STRAIGHT)[0] == (-1.0, -0.1, -5.0)


def test_parameters_of_all_ages():
    assert read_axes(0.4, "linear_scale") == {"x": 0.4}
    assert read_axes({"x": 1, "y": 2}, "linear_scale") == {"x": 1.0, "y": 2.0}
    for wrong in ("fast", {"yaw": 1.0}, {"x": "a"}):
        with pytest.raises(ValueError, match=r"linear_scale is .* numbers for x, y, z"):
            read_axes(wrong, "linear_scale")
