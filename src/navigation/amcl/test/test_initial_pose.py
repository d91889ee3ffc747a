"""The pose that a node started again goes on from, on a parameter server of our own."""

import http.client
import xmlrpc.client

import numpy as np
import pytest
import rospy

from amcl.initial_pose import carried_on, initial_pose, save_pose, saved_pose

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
