"""Two nodes that publish the same transform: each says it once, with both names."""

from types import SimpleNamespace

import pytest
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from nav_nodes import broadcasting
from nav_nodes.broadcasting import SoleBroadcaster


@pytest.fixture
def world(monkeypatch):
    """The node /amcl and what it says; `hear` a transform, at a time in s."""
    found = SimpleNamespace(said=[], now=0.0)
    monkeypatch.setattr(broadcasting, "time", SimpleNamespace(monotonic=lambda: found.now))
    monkeypatch.setattr(rospy, "get_name", lambda: "/amcl")
    monkeypatch.setattr(rospy, "logwarn", lambda text, *values: found.said.append(text % values))
    monkeypatch.setattr(rospy, "Subscriber", lambda topic, _kind, take, lasting:
                        setattr(found, topic[1:], lambda message: take(message, lasting)))
    monkeypatch.setattr(tf2_ros.TransformBroadcaster, "__init__", lambda _: None)
    monkeypatch.setattr(tf2_ros.TransformBroadcaster, "sendTransform", lambda *_: None)
    found.broadcaster = SoleBroadcaster()

    def hear(now, node, child, topic="tf"):
        found.now = now
        message = TFMessage([transform("map", child)])
        message._connection_header = {"callerid": node}
        getattr(found, topic)(message)

    found.hear = hear
    return found


def transform(parent, child):
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id = parent
    return made


def test_it_is_said_once_with_both_names_and_what_to_end(world):
    world.broadcaster.sendTransform(transform("map", "odom"))
    for now in (0.0, 0.5, 1.1, 9.0):
        world.hear(now, "/slam_gmapping", "odom")
    assert world.said == [
        "/amcl and /slam_gmapping both publish the transform from map to odom, so the robot jumps "
        "between two places: end one of the two, by Ctrl-C in its launch file's terminal or by: "
        "rosnode kill /slam_gmapping"]


def test_a_static_one_comes_only_once(world):
    world.broadcaster.sendTransform([transform("map", "odom")])
    world.hear(0.0, "/fixed", "odom", "tf_static")
    assert "/amcl and /fixed both" in world.said[0]


@pytest.mark.parametrize(("times", "node", "child"), [
    ((0.0, 9.0), "/amcl", "odom"), ((0.0, 9.0), "/gazebo", "base_footprint"),
    ((0.0, 0.5), "/slam_gmapping", "odom")])  # which ended soon
def test_other_transforms_are_nothing_to_say(world, times, node, child):
    world.broadcaster.sendTransform(transform("map", "odom"))
    for now in times:
        world.hear(now, node, child)
    assert world.said == []
