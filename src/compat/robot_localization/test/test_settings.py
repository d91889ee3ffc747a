"""What is said of a parameter that is none."""

import pytest
import rospy
from robot_localization.filtering.measurements import BadConfig
from robot_localization.settings import frame, number


@pytest.mark.parametrize("value", ["x", [1.0], {}])
def test_what_is_no_number_is_named(monkeypatch, value):
    monkeypatch.setattr(rospy, "get_param", lambda *_: value)
    with pytest.raises(BadConfig, match=r"^frequency is .*; it has to be a number$"):
        number("frequency", 30.0)


def test_numbers_and_frames(monkeypatch):
    monkeypatch.setattr(rospy, "get_param", lambda *_: 20)
    assert number("frequency", 30.0) == 20.0 and frame("map_frame", "map") == "20"
    monkeypatch.setattr(rospy, "get_param", lambda *_: "/map")
    assert frame("map_frame", "map") == "map"
