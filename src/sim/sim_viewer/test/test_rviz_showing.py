"""One display at work: when its messages are shown, and what the list says below it."""

import time

import numpy as np
import pytest
import rospy
from rviz_messages import grid, scan
from rviz_view import MadeUpView
from sim_viewer.rviz import showing
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.options import check_all
from sim_viewer.rviz.showing import Showing
from sim_viewer.rviz.types import TYPES

from bullet_sim.pose import IDENTITY, Pose

SENDER = "Transform [sender=/laser_node]"
LATE = ("error", "For frame [laser]: Frame [laser] does not exist")


class Raw:
    """A message as rospy gives it, unread."""

    _buff = b""

    def __init__(self, message):
        self.message = message


def read(raw):
    if raw.message is None:
        raise Problem("this is no sensor_msgs/LaserScan")
    return raw.message, "/laser_node"


def begin(name="LaserScan", **options):
    kind = TYPES[f"rviz/{name}"]
    view = MadeUpView()
    return Showing(kind, check_all(kind.options, options), view, read), view


def scan_at(stamp):
    message = scan()
    message.header.stamp = rospy.Time.from_sec(stamp)
    return Raw(message)


def test_a_display_waits_for_messages_and_counts_them():
    shown, view = begin()
    assert shown.look() is None and shown.statuses == {"Topic": ("warning", "No messages received")}
    view.places["laser"] = Pose((1.0, 0.0, 0.0))
    shown.waiting.put(scan_at(1.0))
    (part,) = shown.look()
    assert part.pose.position == (1.0, 0.0, 0.0)
    assert shown.statuses == {"Topic": ("ok", "1 messages received"), SENDER: (
        "ok", "Transform OK"), "Points": ("ok", "Showing 300 points")}
    assert shown.look() is None


def test_a_message_waits_for_its_transform_and_then_is_shown(monkeypatch):
    monkeypatch.setattr(showing, "PATIENCE", 0.0)
    shown, view = begin()
    shown.waiting.put(scan_at(1.0))
    shown.look()
    time.sleep(0.001)
    assert shown.look() is None and shown.statuses[SENDER] == LATE
    view.places["laser"], view.known_until = IDENTITY, 2.0
    shown.waiting.put(scan_at(2.0))
    shown.waiting.put(scan_at(3.0))  # is shown when tf is as far
    assert len(shown.look()) == 1
    assert shown.statuses[SENDER] == ("ok", "Transform OK")
    assert shown.look() is None
    view.known_until = 3.0
    assert len(shown.look()) == 1


def test_what_cannot_be_read_is_an_error_until_one_comes_that_can():
    shown, view = begin()
    view.places["laser"] = IDENTITY
    shown.waiting.put(Raw(None))
    assert shown.look() is None
    assert shown.statuses["Topic"] == ("error", "this is no sensor_msgs/LaserScan")
    shown.waiting.put(scan_at(1.0))
    assert shown.look() and shown.statuses["Topic"] == ("ok", "2 messages received")


def test_options_and_the_fixed_frame_change_what_is_there():
    shown, view = begin()
    view.places["laser"] = IDENTITY
    shown.waiting.put(scan_at(1.0))
    shown.look()
    options = check_all(TYPES["rviz/LaserScan"].options,
                        {"Style": "Points", "Size (Pixels)": 7, "Color Transformer": "FlatColor"})
    shown.change(options, "map")
    (part,) = shown.look()
    assert (part.fields["size"], part.fields["unit"]) == (7, "px")
    view.places["laser"] = Pose((0.0, 3.0, 0.0))  # as seen from odom
    shown.change(options, "odom")
    (part,) = shown.look()
    assert part.pose.position == (0.0, 3.0, 0.0) and view.fixed_frame == "odom"


@pytest.mark.parametrize("spoil", [
    lambda message: setattr(message.info, "width", 1 << 31),
    lambda message: setattr(message, "data", np.zeros(3, np.int8)),
    lambda message: setattr(message, "data", None),
])
def test_hostile_maps_are_an_error_and_a_good_one_is_shown_again(spoil):
    shown, _ = begin("Map")
    broken = grid()
    spoil(broken)
    for message, level in ((grid(), "ok"), (broken, "error"), (grid(), "ok")):
        shown.waiting.put(Raw(message))
        parts = shown.look()
        assert shown.statuses["Topic"][0] == level
        assert len(parts) == (level == "ok")


def test_a_map_without_its_frame_is_hidden_and_the_list_says_why():
    shown, _ = begin("Map")
    message = grid()
    message.header.frame_id = "moon"
    shown.waiting.put(Raw(message))
    assert shown.look() == []
    assert shown.statuses["Transform"] == ("error", "No transform from [moon] to [map]")
