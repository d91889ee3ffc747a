"""amcl's parts without a master: several lasers, a clock set back, and a pose to go on from."""

import http.client
import threading
import xmlrpc.client
from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from sensor_msgs.msg import LaserScan

from amcl.initial_pose import carried_on, initial_pose, save_pose, saved_pose
from amcl.node import AmclNode
from amcl.outputs import Outputs
from nav_nodes.laser_mount import Mount


@pytest.fixture
def node(monkeypatch):
    """One that localises nothing; `events` has what it does, with its odometry's x."""
    found = AmclNode.__new__(AmclNode)
    found.events = events = []
    found._values = {"laser_min_range": -1.0, "laser_max_range": -1.0}
    found._lock, found._newest = threading.RLock(), rospy.Time(0)
    found._saved, found._has_jumped = None, False
    found._missing_data = SimpleNamespace(present=lambda _what: None)
    found._scans = SimpleNamespace(resolved_name="/scan")
    found._frames = SimpleNamespace(
        mount=lambda _frame: Mount(np.zeros(3), False), clear=lambda: events.append("cleared"),
        odometry=lambda stamp, _patience: np.array([stamp.to_sec(), 0.0, 0.0]))
    found._outputs = SimpleNamespace(restart=lambda: None)
    found._localisation = SimpleNamespace(
        add=lambda odometry, *_: events.append(f"scan at {odometry[0]:g}"),
        jump_to=lambda odometry: events.append(f"jump to {odometry[0]:g}"))
    found._publish = lambda *_: None
    monkeypatch.setattr(rospy, "logwarn", lambda text, *values: events.append(text % values))
    return found


def take(node, *stamps):
    for stamp in stamps:
        scan = LaserScan(range_max=3.5, ranges=[1.0])
        scan.header.stamp = rospy.Time.from_sec(stamp)
        node._use_scan(scan)
    return node.events


def test_scans_of_two_lasers_may_come_in_the_wrong_order(node):
    stamps = 10.0, 9.98, 10.1, 10.08, 10.2, 9.3, 10.21
    assert take(node, *stamps) == [f"scan at {stamp:g}" for stamp in stamps]


def test_scans_of_two_lasers_at_one_moment_give_one_transform():
    """tf warns in every listener of a second one."""
    sent, outputs = [], Outputs.__new__(Outputs)
    outputs._latest, outputs._transforms = None, SimpleNamespace(sendTransform=sent.append)
    values = {"transform_tolerance": 0.1, "global_frame_id": "map", "odom_frame_id": "odom"}
    for stamp in (1.0, 1.0, 1.1, 1.05):
        outputs.transform(np.zeros(3), values, rospy.Time.from_sec(stamp))
    assert [message.header.stamp.to_sec() for message in sent] == pytest.approx([1.1, 1.2, 1.15])


def test_many_small_steps_back_are_no_disorder(node):
    """What counts is how far a scan is behind the newest of all."""
    assert "the clock went back by 1.2 s" in take(node, 10.0, 9.4, 8.8)[2]


def test_the_clock_was_set_back(node):
    events = take(node, 100.0, 100.2, 3.0, 3.2)
    assert "the clock went back by 97.2 s" in events.pop(2)
    assert events == ["scan at 100", "scan at 100.2", "cleared", "jump to 3", "scan at 3",
                      "scan at 3.2"]


def test_a_scan_from_before_the_clock_was_set_back_comes_too_late(node):
    """It waited for its odometry while another laser's scan told of it."""
    odometry = node._frames.odometry

    def wait(stamp, patience):
        if stamp.to_sec() == 100.2:
            take(node, 3.0)
        return odometry(stamp, patience)

    node._frames.odometry = wait
    events = take(node, 100.0, 100.2, 3.2)
    assert events[2:] == ["cleared", "jump to 3", "scan at 3", "scan at 3.2"]


VALUES = {f"initial_pose_{axis}": 0.0 for axis in "xya"} | {
    f"initial_cov_{axes}": 0.25 for axes in ("xx", "yy", "aa")}
POSE, SPREAD, ODOMETRY = np.array([1.5, -2.0, 0.3]), np.diag([0.01, 0.02, 0.03]), np.ones(3)


@pytest.fixture(autouse=True)
def server(monkeypatch):
    kept = {}
    monkeypatch.setattr(rospy, "get_time", lambda: kept.get("now", 100.0))
    monkeypatch.setattr(rospy, "set_param", kept.__setitem__)
    monkeypatch.setattr(rospy, "get_param", lambda name, default: kept.get(name, default))
    return kept


def test_what_was_saved_is_read_with_its_odometry():
    save_pose(POSE, SPREAD, ODOMETRY)
    for found, kept in zip(saved_pose(VALUES), (POSE, SPREAD, ODOMETRY), strict=True):
        assert np.array_equal(found, kept)


@pytest.mark.parametrize("error", [
    OSError(), xmlrpc.client.Fault(1, "no"), xmlrpc.client.ProtocolError("", 500, "", {}),
    http.client.BadStatusLine(""), rospy.ROSException("no")])
def test_a_master_that_answers_amiss_does_not_end_the_thread_that_saves(monkeypatch, error):
    def fail(*_):
        raise error

    monkeypatch.setattr(rospy, "set_param", fail)
    save_pose(POSE, SPREAD, ODOMETRY)


@pytest.mark.parametrize("changes", [
    {"~initial_pose_x": 0.0}, {"~saved_pose": "text"}, {"~saved_pose": {"pose": [1.5, -2.0, 0.3]}},
    {"~saved_pose": {"pose": [1.5, -2.0, 0.3], "odometry": [0.0], "stamp": 99.0}},
    {"now": 99.0}, {"now": 161.0}])
def test_a_pose_that_was_set_since_or_is_old_is_not_moved(server, changes):
    assert saved_pose(VALUES) is None
    save_pose(POSE, SPREAD, ODOMETRY)
    server.update(changes)
    assert saved_pose(VALUES) is None
    assert initial_pose(VALUES)[0][1] == -2.0


def test_it_is_carried_on_by_the_odometry_and_less_sure_by_a_part_of_the_way():
    pose, spread = carried_on(np.array([1.0, 1.0, np.pi / 2]), SPREAD, np.array([5.0, 0, np.pi]),
                              np.array([4.5, 0.0, np.pi]))
    assert pose == pytest.approx((1.0, 1.5, np.pi / 2))
    assert np.diag(spread) == pytest.approx((0.02, 0.03, 0.04))
    assert carried_on(POSE, SPREAD, ODOMETRY, ODOMETRY)[1] == pytest.approx(SPREAD)
