"""One display at work: when its messages are shown, and what the list says below it."""

import time
import weakref

import numpy as np
import pytest
import rospy
from rviz_messages import grid, odometry, scan
from rviz_view import MadeUpView
from sim_viewer.rviz import showing
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.options import check_all
from sim_viewer.rviz.showing import Showing
from sim_viewer.rviz.types import TYPES
from visualization_msgs.msg import Marker

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
        raise Problem("this is not a sensor_msgs/LaserScan")
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
    assert shown.statuses["Topic"] == ("error", "this is not a sensor_msgs/LaserScan")
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


def test_what_was_shown_goes_with_the_fixed_frame_it_was_placed_in():
    shown, view = begin()
    view.places["laser"] = IDENTITY
    shown.waiting.put(scan_at(1.0))
    assert len(shown.look()) == 1
    del view.places["laser"]  # in moon, nobody knows where it is
    shown.change(check_all(TYPES["rviz/LaserScan"].options, {}), "moon")
    assert shown.look() == [] and shown.look() is None


def test_an_error_stays_until_something_can_be_drawn():
    shown, view = begin()
    view.places["laser"] = IDENTITY
    broken = scan_at(1.0)
    broken.message.angle_increment = np.nan
    shown.waiting.put(broken)
    for _ in range(2):
        assert shown.look() is None
        assert shown.statuses["Error"] == ("error", "The scan's angles are not numbers")
    shown.waiting.put(scan_at(2.0))
    assert shown.look() and "Error" not in shown.statuses


@pytest.mark.parametrize("name, make", [("Map", grid), ("Marker", Marker)])
def test_messages_that_were_shown_are_not_kept(name, make):
    shown, view = begin(name)
    raw = Raw(make())
    gone = weakref.ref(raw)
    shown.waiting.put(raw)
    del raw
    shown.look()
    assert gone() is None
    view.places["map"] = Pose((4.0, 0.0, 0.0))
    shown.change(check_all(TYPES[f"rviz/{name}"].options, {}), "odom")
    assert name == "Marker" or shown.look()[0].pose.position[0] == 1.0


def test_a_long_decay_time_keeps_only_what_there_is_room_for(monkeypatch):
    monkeypatch.setattr(showing, "MOST_BYTES", 100)
    shown, view = begin(**{"Decay Time": 60.0})
    view.places["laser"] = IDENTITY
    for second in (1.0, 2.0, 3.0, 4.0):
        view.now = second
        message = scan_at(second)
        message._buff = bytes(40)
        shown.waiting.put(message)
        parts = shown.look()
    assert len(parts) == 2
    assert shown.statuses["Messages"] == (
        "warning", "showing the last 2: there is no room for more")


def test_when_time_begins_anew_the_old_trail_is_gone():
    shown, view = begin("Odometry")
    view.places["odom"] = IDENTITY
    for second, x in ((100.0, 0.0), (101.0, 5.0), (0.1, 9.0)):
        view.now = second
        message = odometry()
        message.pose.pose.position.x = x
        shown.waiting.put(Raw(message))
        parts = shown.look()
    assert len(parts[0].arrays["rows"]) == 1
