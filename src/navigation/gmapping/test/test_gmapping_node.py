"""When the node takes the clock for set back, and what it does with scans that come; no master."""

import threading
from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from sensor_msgs.msg import LaserScan

from gmapping.mapper import ScanError
from gmapping.node import SlamNode


@pytest.fixture
def node(monkeypatch):
    """One that maps nothing; `events` has what it does beside."""
    found = SlamNode.__new__(SlamNode)
    found.events = []
    found._values = {"map_update_interval": 5.0}
    found._frames = {"odom_frame": "odom", "base_frame": "base_link"}
    found._newest, found._map = rospy.Time(0), None
    found._lock, found._scans = threading.Lock(), SimpleNamespace(resolved_name="/scan")
    found._watchdog = SimpleNamespace(heard=nullcontext)
    found._mounts = SimpleNamespace(of=lambda _frame: True)
    found._mapper = SimpleNamespace(take=lambda *_: True, is_wanted=lambda: True,
                                    slam=SimpleNamespace(map_to_odom=None))
    found._transforms = SimpleNamespace(
        pose=lambda *_: np.zeros(3),
        buffer=SimpleNamespace(clear=lambda: found.events.append("no transforms")))

    def publish(stamp):
        found._map = LaserScan()  # anything with a header
        found._map.header.stamp = stamp
        found.events.append(f"map at {stamp.to_sec():g} s")

    found._publish_map = publish
    monkeypatch.setattr(rospy, "logwarn", lambda text, *values: found.events.append(text % values))
    return found


def take(node, *stamps):
    for stamp in stamps:
        scan = LaserScan()
        scan.header.stamp = rospy.Time.from_sec(stamp)
        node._use_scan(scan)
    return node.events


def test_scans_of_two_lasers_may_come_in_the_wrong_order(node):
    assert take(node, 10.0, 10.1, 10.05, 10.2, 10.15, 9.9) == ["map at 10 s"]


def test_scans_of_two_lasers_are_mapped_one_at_a_time(node):
    """rospy calls on a thread for each publisher."""
    together, met = threading.Barrier(2), []

    def map_scan(*_):
        try:
            together.wait(0.3)  # s; for somebody else who is in here
            met.append(True)
        except threading.BrokenBarrierError:
            met.append(False)
        return True

    node._mapper.take = map_scan
    lasers = [threading.Thread(target=node._take_scan, args=(LaserScan(),)) for _ in range(2)]
    for laser in lasers:
        laser.start()
    for laser in lasers:
        laser.join(60.0)
    assert met == [False, False]


def test_a_scan_of_before_a_reset_is_not_mapped_after_it(node):
    """It had its odometry already, and waited for another laser's to be mapped."""

    def pose(*_):
        node._newest = rospy.Time(1)
        return np.zeros(3)

    node._transforms.pose = pose
    assert take(node, 50.0) == []


def test_a_laser_that_waits_for_its_odometry_does_not_hold_up_another(node):
    waits, is_over = threading.Event(), threading.Event()
    late = threading.Thread(target=take, args=(node, 0.0))

    def pose(*_):
        if threading.current_thread() is not late:
            return np.zeros(3)
        waits.set()
        is_over.wait(60.0)
        return None

    node._transforms.pose = pose
    late.start()
    assert waits.wait(60.0)
    node._take_scan(LaserScan())
    assert node.events == ["map at 0 s"] and late.is_alive()
    is_over.set()
    late.join(60.0)


def test_a_scan_that_no_map_can_be_made_of_is_left_out_with_a_line(node, monkeypatch):
    def refuse(*_):
        raise ScanError("of 1e+06 m")

    node._mapper.take = refuse
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda seconds, text, *values:
                        node.events.append((seconds, text % values)))
    assert take(node, 10.0) == [(5.0, "/scan: of 1e+06 m")]


def test_the_clock_was_set_back(node):
    events = take(node, 100.0, 100.2, 3.0, 3.2)
    assert events[0] == "map at 100 s" and events[2:] == ["no transforms", "map at 3 s"]
    assert "went back by 97.2 s" in events[1]
