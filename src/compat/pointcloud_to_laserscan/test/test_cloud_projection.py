"""Points whose ranges are known, scans whose points are, and points into another frame."""

import math

import numpy as np
import pytest
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from pointcloud_to_laserscan.projection import Settings, points_of, ranges_of, rotation
from pointcloud_to_laserscan.target_frame import TargetFrame
from std_msgs.msg import Header


def test_upstreams_defaults():
    settings = Settings()
    assert settings.count == 360
    ranges = ranges_of(np.array([[1.0, 0.0, 0.0], [2.0, 0.0, 0.1]]), settings)
    assert ranges[180] == 2.0  # the floor at z = 0 is not above min_height
    assert np.isinf(np.delete(ranges, 180)).all()


def test_nearest_of_an_angle_within_heights_and_ranges():
    settings = Settings(min_height=-1.0, max_height=1.0, angle_min=-math.pi / 2,
                        angle_max=math.pi / 2, angle_increment=math.pi / 4, range_min=0.5,
                        range_max=10.0, use_inf=False)
    points = np.array([[3.0, 0.1, 0.0], [4.0, 0.1, 0.0], [0.1, 0.1, 0.0], [2.0, 0.1, 5.0],
                       [0.1, -6.0, 0.0], [-1.0, 0.0, 0.0], [np.nan, 0.0, 0.0], [50.0, 0.1, 0.0],
                       [0.0, 7.0, 0.0]])
    assert ranges_of(points, settings) == pytest.approx(
        [math.hypot(0.1, 6.0), 11.0, math.hypot(3.0, 0.1), 7.0])


def test_angles_that_are_none_are_refused():
    with pytest.raises(ValueError, match="angle_increment 0 leave no angles"):
        Settings(angle_increment=0.0)


def test_scan_to_points_and_back():
    ranges = np.array([1.0, np.inf, 2.0, 0.05, np.nan])
    points, index = points_of(ranges, 0.0, math.pi / 2, 0.1, 10.0)
    assert index.tolist() == [0, 2]
    assert points == pytest.approx(np.array([[1, 0, 0], [-2, 0, 0]], float))


def test_a_quarter_turn_to_the_left():
    half = math.sqrt(0.5)
    assert rotation(0, 0, half, half) @ [1, 0, 0] == pytest.approx([0, 1, 0])


@pytest.mark.parametrize("wrong", [{"angle_min": "a"}, {"use_inf": "yes"}, {"range_max": True}])
def test_a_parameter_of_another_kind_is_named(wrong):
    with pytest.raises(ValueError, match=f"parameter {next(iter(wrong))} is "):
        Settings(**wrong)


@pytest.fixture
def base(monkeypatch):
    """The frame `base` at 10 s by the clock; frame `mast` is 1 m above it, turned to the left."""
    monkeypatch.setattr(rospy, "get_time", lambda: 10.0)
    frame = TargetFrame.__new__(TargetFrame)
    frame.name, frame.tolerance = "base", rospy.Duration(0)
    frame.buffer = tf2_ros.Buffer(debug=False)
    mast = TransformStamped(header=Header(frame_id="base"), child_frame_id="mast")
    mast.transform.translation.z = 1.0
    mast.transform.rotation.z = mast.transform.rotation.w = 0.5 ** 0.5
    frame.buffer.set_transform_static(mast, "test")
    return frame


@pytest.mark.parametrize(("source", "expected"), [
    ("mast", [0, 2, 1]), ("/mast", [0, 2, 1]), ("base", [2, 0, 0])])
def test_points_are_turned_into_it(base, source, expected):
    header = Header(frame_id=source, stamp=rospy.Time(10))
    assert base.turned(np.array([[2.0, 0, 0]]), header) == pytest.approx(np.array([expected]))


@pytest.mark.parametrize(("source", "second"), [
    ("other", 10), ("ma\0st", 10), ("mast", 2**32 - 1)])  # the last one, asked of tf2, is SIGABRT
def test_what_cannot_be_looked_up_is_one_exception(base, source, second):
    header = Header(frame_id=source, stamp=rospy.Time(second))
    with pytest.raises(tf2_ros.TransformException) as caught:
        base.turned(np.zeros((1, 3)), header)
    assert "\n" not in str(caught.value)
