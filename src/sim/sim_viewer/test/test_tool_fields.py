"""Paths to numbers in messages."""

import pytest
from nav_msgs.msg import Odometry
from rospy import Time
from sensor_msgs.msg import JointState, LaserScan
from sim_viewer.registry import Refused
from sim_viewer.tools.messages import expand, numeric_paths, parse_steps, split_topic, value
from std_msgs.msg import String, UInt8MultiArray


def test_the_longest_topic_that_fits_is_taken():
    topics = ["/odom", "/odom/raw", "/odometry"]
    assert split_topic("/odom/pose/pose/position/x", topics) == ("/odom", "pose/pose/position/x")
    assert split_topic("/odom/raw/data", topics) == ("/odom/raw", "data")
    assert split_topic("/odom", topics) == ("/odom", "")
    with pytest.raises(Refused, match="/odo/x: no such topic"):
        split_topic("/odo/x", topics)


def test_elements_have_two_spellings():
    assert parse_steps("ranges[10]") == parse_steps("ranges/10") == ["ranges", 10]
    assert parse_steps("a/b[0][2]/c") == ["a", "b", 0, 2, "c"]
    for wrong in ("a[", "a[-1]", "a b", "__class__", "a[1]x", "a[9999999999]"):
        with pytest.raises(Refused):
            parse_steps(wrong)


def test_values_are_the_messages_own():
    odometry = Odometry()
    odometry.pose.pose.position.x = 1.25
    odometry.pose.covariance = [float(i) for i in range(36)]
    odometry.header.stamp = Time(3, 500_000_000)
    assert value(odometry, parse_steps("pose/pose/position/x")) == 1.25
    assert value(odometry, parse_steps("pose/covariance[35]")) == 35.0
    assert value(odometry, parse_steps("header/stamp")) == 3.5
    assert value(LaserScan(ranges=[1.0]), parse_steps("ranges[1]")) is None
    assert value(UInt8MultiArray(data=b"\x07"), parse_steps("data[0]")) == 7.0


def test_a_path_may_stand_for_several_lines():
    assert expand("pose/pose/position/x:y", Odometry) == [
        "pose/pose/position/x", "pose/pose/position/y"]
    assert expand("twist/twist/linear", Odometry) == [
        f"twist/twist/linear/{axis}" for axis in "xyz"]
    assert expand("", LaserScan)[:2] == ["angle_min", "angle_max"]


@pytest.mark.parametrize("path, message_class, reason", [
    ("pose/pose/position/w", Odometry, "Point has no field 'w'; it has: x, y, z"),
    ("child_frame_id", Odometry, "string is not a number"),
    ("pose/covariance", Odometry, r"it has: an index as \[0\]"),
    ("pose[0]", Odometry, "has no elements"),
    ("data", String, "string is not a number"),
    ("", Odometry, "it has: header, child_frame_id, pose, twist"),
])
def test_what_is_no_number_is_told_with_what_there_is(path, message_class, reason):
    with pytest.raises(Refused, match=reason):
        expand(path, message_class)


def test_the_numbers_of_a_type_are_all_offered_and_all_fit():
    for message_class in (Odometry, LaserScan, JointState):
        paths = numeric_paths(message_class)
        assert [expand(path, message_class) for path in paths] == [[path] for path in paths]
    assert "position[0]" in numeric_paths(JointState)
    assert "name[0]" not in numeric_paths(JointState)
