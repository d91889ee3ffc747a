"""When the node takes the clock for set back; no master."""

from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from sensor_msgs.msg import LaserScan

from gmapping.node import SlamNode


@pytest.fixture
def node(monkeypatch):
    """One that maps nothing; `events` has what it does beside."""
    found = SlamNode.__new__(SlamNode)
    found.events = []
    found._values = {"map_update_interval": 5.0}
    found._frames = {"odom_frame": "odom", "base_frame": "base_link"}
    found._newest, found._map = rospy.Time(0), None
    found._mounts = SimpleNamespace(of=lambda _frame: True)
    found._mapper = SimpleNamespace(take=lambda *_: True, slam=SimpleNamespace(map_to_odom=None))
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


def test_the_clock_was_set_back(node):
    events = take(node, 100.0, 100.2, 3.0, 3.2)
    assert events[0] == "map at 100 s" and events[2:] == ["no transforms", "map at 3 s"]
    assert "went back by 97.2 s" in events[1]
