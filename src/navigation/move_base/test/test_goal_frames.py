"""Goals in frames that tf knows, and in others: what is said then names the goal's frame."""

import pytest
import rospy
import tf2_py
from geometry_msgs.msg import PoseStamped, TransformStamped

from move_base.goals import in_frame
from nav_nodes.transforms import Transforms

CHAIN = ("map", "odom", "base_footprint")


@pytest.fixture
def transforms():
    """The robot at x 1, y 0 on the map; no topics."""
    found = Transforms.__new__(Transforms)
    found.chain, found.buffer = CHAIN, tf2_py.BufferCore(rospy.Duration(30))
    for parent, child, x in (("map", "odom", 1.0), ("odom", "base_footprint", 0.0)):
        message = TransformStamped(child_frame_id=child)
        message.header.frame_id = parent
        message.transform.translation.x, message.transform.rotation.w = x, 1.0
        found.buffer.set_transform_static(message, "test")
    return found


def goal(frame):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x = message.pose.orientation.w = 1.0
    return message


@pytest.fixture
def lines(monkeypatch):
    found = []
    monkeypatch.setattr(rospy, "logwarn_throttle",
                        lambda _period, text, *values: found.append(text % values))
    return found


def test_the_frame_that_nobody_knows_is_named(transforms, lines):
    assert in_frame(goal("mapp"), "map", transforms) is None
    assert lines == ["Failed to transform the goal pose into the map frame: nothing on /tf or "
                     "/tf_static knows its frame_id mapp; write for example map"]


def test_frames_that_are_known_or_should_be(transforms):
    assert all(transforms.knows(frame) for frame in CHAIN)
    transforms.buffer.clear()
    assert all(transforms.knows(frame) for frame in CHAIN)  # their absence is the robot's
    assert not transforms.knows("mapp")
