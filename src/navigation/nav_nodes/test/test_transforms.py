"""Which missing transform is to blame, in one story, by a tf2 buffer without topics."""

import threading

import pytest
import rospy
import tf2_py
import tf2_ros
from geometry_msgs.msg import TransformStamped

from nav_nodes.transforms import TfLink, Transforms, known_links, weakest

LATE = 2.0  # s by which the odometry's transforms come after their stamps


class Told:
    """MissingData that are only counted."""

    def __init__(self):
        self.missed, self.back = [], []

    def missing(self, what, *_, **__):
        self.missed.append(what)

    def present(self, what):
        self.back.append(what)


@pytest.fixture
def late(monkeypatch):
    """At 10 s by the clock, what tf knows of the odometry ends 2 s ago."""
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time(10))
    found = Transforms.__new__(Transforms)
    found.chain, found.buffer = ("odom", "base"), tf2_ros.Buffer(rospy.Duration(30), debug=False)
    found._missing_data, found._lock, found._blamed = Told(), threading.Lock(), {}
    for child, stamp in (("base", 7.0), ("base", 10.0 - LATE), ("laser", 0.0)):
        message = TransformStamped(child_frame_id=child)
        message.header.frame_id = "odom" if child == "base" else "base"
        message.header.stamp = rospy.Time.from_sec(stamp)
        message.transform.rotation.w = 1.0
        put = found.buffer.set_transform if stamp else found.buffer.set_transform_static
        put(message, "test")
    return found


def test_a_lookup_that_succeeds_in_the_past_does_not_say_that_all_is_well(late):
    """Scans of two seconds ago have their transform in the end; the newest is late all the same."""
    for stamp in (9, 7, 9, 7):  # s: too new, then old enough
        assert late.newest_pose("odom", "base", 0.5) is None
        assert (late.find("odom", "laser", rospy.Time(stamp)) is None) == (stamp == 9)
    assert set(late._missing_data.missed) == {"new transform from odom to base"}
    assert late._missing_data.back == []


@pytest.mark.parametrize(("child", "second"), [("la\0ser", 9), ("laser", 2**32 - 1)])
def test_what_tf2_does_not_take_is_missed_like_any_other(late, child, second):
    """Asked for the first it raises ValueError, for the second it ends the process."""
    assert late.find("odom", child, rospy.Time(second)) is None
    assert late.pose("odom", child, rospy.Time(second), wait_s=0.1) is None
    assert late._missing_data.missed


def test_when_nobody_misses_it_any_more_it_is_back(late):
    late.newest_pose("odom", "base", 0.5)
    late.find("odom", "laser", rospy.Time(9))
    late.find("odom", "laser", rospy.Time(7))
    assert late.newest_pose("odom", "base", 3.0) is not None
    assert set(late._missing_data.back) == {"new transform from odom to base"}


def test_a_stamp_of_another_age_is_not_asked_of_tf_which_would_abort(late):
    assert late.pose("odom", "base", rospy.Time(2**32 - 1)) is None
    assert late.find("odom", "laser", rospy.Time(2**32 - 1)) is None
    assert late._missing_data.missed


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
