"""Which transform is to blame, by a tf2 buffer without ROS around it."""

import pytest
import rospy
import tf2_py
from geometry_msgs.msg import TransformStamped

from nav_nodes.tf_gaps import TfLink, known_links, weakest

CHAIN = ("map", "odom", "base")


def links(*known):
    """Of (parent, child, newest stamp, s; 0: static)."""
    buffer = tf2_py.BufferCore(rospy.Duration(30))
    for parent, child, newest in known:
        message = TransformStamped(child_frame_id=child)
        message.header.frame_id, message.header.stamp = parent, rospy.Time.from_sec(newest)
        message.transform.rotation.w = 1.0
        (buffer.set_transform if newest else buffer.set_transform_static)(message, "test")
    return known_links(buffer)


@pytest.mark.parametrize("known, asked, blamed", [
    ([], ("map", "base"), ("odom", "base")),
    ([], ("odom", "base"), ("odom", "base")),
    ([], ("base", "laser"), ("base", "laser")),
    ([("map", "odom", 5)], ("map", "base"), ("odom", "base")),
    ([("odom", "base", 5)], ("map", "base"), ("map", "odom")),
    ([("odom", "base", 5)], ("map", "laser"), ("base", "laser")),
    ([("base", "mast", 0)], ("base", "laser"), ("base", "laser")),
    ([("mast", "laser", 0)], ("base", "laser"), ("base", "mast")),
    ([("chassis", "base", 0)], ("map", "base"), ("odom", "chassis")),
    ([("chassis", "base", 0)], ("odom", "base"), ("odom", "chassis")),
    ([("map", "odom", 5), ("odom", "bass", 5), ("bass", "laser", 0)], ("base", "laser"),
     ("odom", "base")),
    ([("odom", "bass", 5), ("bass", "laser", 0)], ("base", "laser"), ("odom", "base"))])
def test_what_never_came(known, asked, blamed):
    assert weakest(links(*known), *asked, CHAIN) == TfLink(*blamed, None)


@pytest.mark.parametrize("known, asked, blamed", [
    ([("map", "odom", 7), ("odom", "base", 5)], ("map", "base"), TfLink("odom", "base", 5.0)),
    ([("map", "odom", 5), ("odom", "base", 7)], ("map", "base"), TfLink("map", "odom", 5.0)),
    ([("map", "odom", 5), ("odom", "base", 5.2)], ("map", "base"), TfLink("odom", "base", 5.2)),
    ([("odom", "base", 5), ("base", "laser", 0)], ("odom", "laser"), TfLink("odom", "base", 5.0)),
    ([("odom", "base", 5), ("base", "laser", 0)], ("laser", "odom"), TfLink("odom", "base", 5.0)),
    ([("base", "laser", 0)], ("base", "laser"), TfLink("base", "laser", 0.0))])
def test_the_oldest_of_what_came(known, asked, blamed):
    assert weakest(links(*known), *asked, CHAIN) == blamed
