"""When a sensor's messages count, with a tf that is made up; no master."""

from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import Point32, Transform
from sensor_msgs.msg import LaserScan, PointCloud

from costmap_2d import sources
from costmap_2d.settings import table
from costmap_2d.sources import MessageAge


class Frames:
    """The sensor moves with 1 m/s along x, 0.3 m above the floor; known up to `until`, s."""

    def __init__(self):
        self.until = 100.0
        self.buffer = SimpleNamespace(can_transform=lambda *asked: self.find(*asked) is not None)

    def find(self, _parent, child, stamp):
        if stamp.to_sec() > self.until:
            return None
        found = Transform()
        found.translation.x = stamp.to_sec() + (child == "elsewhere") * 10
        found.translation.z = 0.3
        found.rotation.w = 1.0
        return found


@pytest.fixture
def missing_data():
    """What is missing, with the advice."""
    return {}


@pytest.fixture
def lines(monkeypatch):
    """What is warned of."""
    found = []
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda _period, text, *values: found.append(
        text % values))
    return found


@pytest.fixture
def make(monkeypatch, missing_data):
    """A source of these settings and the frames that it goes by, at time 10 s."""
    at = {"now": 10.0}
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time.from_sec(at["now"]))

    def make_source(**settings):
        values = {entry.name: entry.default for entry in table("source")}
        frames = Frames()
        source = sources.Source({**values, "topic": "scan", **settings}, "map", frames,
                                SimpleNamespace(
                                    missing=lambda what, why, **_: missing_data.update({what: why}),
                                    present=lambda what: missing_data.pop(what, None)))
        return source, frames

    make_source.at = at
    return make_source


def cloud(stamp, *points):
    message = PointCloud(points=[Point32(*point) for point in points or [(1, 0, 0)]])
    message.header.stamp, message.header.frame_id = rospy.Time.from_sec(stamp), "/laser"
    return message


def test_the_newest_counts_until_the_next(make):
    source, _ = make()
    assert source.collect() == []
    for stamp in (1.0, 2.0):
        source._take(cloud(stamp))
    (seen,) = source.collect()
    assert seen.origin.tolist() == [2, 0, 0.3] and seen.points == pytest.approx(
        np.array([[3, 0, 0.3]]))
    assert source.collect() == [seen]
    assert (seen.obstacle_range, seen.raytrace_range) == (2.5, 3.0)


def test_a_message_waits_for_its_transform(make):
    source, frames = make()
    frames.until = 1.5
    for stamp in (1.0, 2.0):
        source._take(cloud(stamp))
    assert source.collect()[0].origin[0] == 1.0
    frames.until = 2.5
    assert source.collect()[0].origin[0] == 2.0


def test_persistence_keeps_what_is_new_enough(make):
    source, frames = make(observation_persistence=2.0)
    frames.until = 9.2
    for stamp in (7.0, 9.0, 9.5):
        source._take(cloud(stamp))
    assert [seen.origin[0] for seen in source.collect()] == [9.0]
    frames.until = 9.8
    assert [seen.origin[0] for seen in source.collect()] == [9.5, 9.0]


def test_heights_count_in_the_costmaps_frame(make):
    source, _ = make(min_obstacle_height=0.25, max_obstacle_height=0.5)
    source._take(cloud(1.0, (0, 0, -0.1), (1, 0, 0.0), (2, 0, 0.2), (3, 0, 0.3)))
    assert source.collect()[0].points[:, 0].tolist() == [2.0, 3.0]


def test_rays_begin_in_the_frame_of_the_sensor(make):
    source, _ = make(sensor_frame="/elsewhere")
    source._take(cloud(1.0))
    (seen,) = source.collect()
    assert seen.origin[0] == 11.0 and seen.points[0, 0] == 2.0


def test_a_sweep_takes_its_time(make):
    source, frames = make(data_type="LaserScan")
    message = LaserScan(ranges=[1.0, 1.0, 1.0], range_max=5.0, time_increment=0.5)
    message.header.stamp, message.header.frame_id = rospy.Time(2), "laser"
    source._take(message)
    frames.until = 2.9
    assert source.collect() == []
    frames.until = 3.0
    assert source.collect()[0].points[:, 0].tolist() == [3.0, 3.5, 4.0]


def test_a_sensor_is_current_within_its_rate(make):
    source, _ = make(expected_update_rate=0.5)
    source._take(cloud(9.9))
    source.collect()
    make.at["now"] = 10.5
    assert source.is_current()
    make.at["now"] = 10.6
    assert not source.is_current()
    source.forget()
    assert source.is_current() and source.collect() == []
    assert make()[0].is_current()


def test_how_long_a_sensor_is_silent(make):
    source, _ = make()
    make.at["now"] = 11.5
    assert source.ages() == MessageAge("PointCloud on /scan",
                                       "PointCloud on /scan that can be placed", 1.5, 1.5)
    source._take(cloud(11.0))
    assert (source.ages().heard, source.ages().placed) == (0.0, 0.0)


def test_what_cannot_be_placed_is_no_news(make):
    """A robot drove on by a laser whose place nobody told."""
    source, frames = make()
    frames.until = 9.0
    for now in (10.2, 10.4, 10.6, 10.8):
        make.at["now"] = now
        source._take(cloud(now))
    assert source.ages().heard == 0.0 and source.ages().placed == pytest.approx(0.8)
    frames.until = 10.65
    assert source.ages().placed == pytest.approx(0.2)  # without an update of the costmap
    source.collect()
    assert source.ages().placed == pytest.approx(0.2)


def test_a_transform_that_comes_after_its_scan_makes_nothing_old(make):
    """At 5 scans a second, tf 30 ms late, and one update a second."""
    source, frames = make()
    oldest = 0.0
    for step in range(1, 300):
        make.at["now"] = now = 10.0 + 0.01 * step
        frames.until = now - 0.03
        if step % 20 == 0:
            source._take(cloud(now))
        if step % 100 == 99:
            source.collect()
        oldest = max(oldest, source.ages().placed)
    assert oldest == pytest.approx(0.22, abs=0.011)


def test_a_quick_sensor_waits_for_slow_transforms(make):
    """At 40 scans a second and tf 0.4 s late none must be pushed out before it can be placed."""
    source, frames = make()
    for step in range(1, 120):
        make.at["now"] = now = 10.0 + step / 40
        frames.until = now - 0.4
        source._take(cloud(now))
        if step % 8 == 0:
            source.collect()
        if now > 10.6:
            assert source.ages().placed < 0.45


def test_a_scan_after_a_damaged_one_is_news_at_once(make, lines):
    source, frames = make(data_type="LaserScan")
    for now, increment in ((11.0, float("nan")), (12.0, 0.0)):
        make.at["now"] = frames.until = now
        message = LaserScan(ranges=[1.0], range_max=5.0, time_increment=increment)
        message.header.stamp, message.header.frame_id = rospy.Time.from_sec(now), "laser"
        source._take(message)
        if now == 11.0:
            assert source.collect() == [] and source.ages().placed == 1.0
    assert source.ages().placed == 0.0


def test_who_sees_nothing_sees(make):
    """Of a scan of no numbers, as of an empty one, the costmap learns what is free: nothing."""
    for ranges in ([], [float("nan")] * 3, [float("inf")] * 3):
        source, frames = make(data_type="LaserScan")
        make.at["now"] = frames.until = 11.0
        message = LaserScan(ranges=ranges, range_max=5.0, time_increment=5.0)
        message.header.stamp, message.header.frame_id = rospy.Time(11), "laser"
        source._take(message)
        assert source.ages().placed == 0.0
        (seen,) = source.collect()
        assert not len(seen.points)
        make.at["now"] = 10.0


def test_a_sweep_that_ends_in_the_future_is_said(make, missing_data):
    """Its beginning is known, so tf has nothing to complain about for long."""
    source, frames = make(data_type="LaserScan")
    message = LaserScan(ranges=[1.0] * 360, range_max=5.0, time_increment=0.05)
    message.header.stamp, message.header.frame_id = rospy.Time(11), "laser"
    make.at["now"] = frames.until = 11.0
    source._take(message)
    assert source.collect() == [] and source.ages().placed == 1.0
    assert "17.9 s (time_increment)" in source.ages().why
    assert "17.9 s (time_increment)" in missing_data[source.ages().usable]
    frames.until = 40.0
    assert source.collect() and source.ages().why == "" and not missing_data


def test_a_pause_makes_nothing_old(make, monkeypatch):
    """shutdown_costmaps."""
    monkeypatch.setattr(rospy, "Subscriber", lambda *_, **__: SimpleNamespace(
        unregister=lambda: None))
    source, _ = make()
    source.start()
    source._take(cloud(10.0))
    source.stop()
    make.at["now"] = 20.0
    source.start()
    assert source.ages().placed == 0.0 and source.collect() == []


@pytest.mark.parametrize("stamp", [2.0e9 + 20, 4294967295.0])
def test_a_message_of_another_age_never_gets_to_tf(make, lines, stamp):
    """tf2 subtracts stamps in 32 bits, and where that is too little the process is aborted."""
    source, frames = make()
    frames.find = lambda *_: pytest.fail("asked")
    source._take(cloud(stamp))
    make.at["now"] = 11.0
    assert source.collect() == [] and source.ages().placed == 1.0
    assert f"dated {stamp:.0f} s has come at 10 s" in source.ages().why and len(lines) == 1


def test_a_damaged_cloud_is_one_line_and_no_news(make, lines):
    source, _ = make(data_type="PointCloud2")
    for now in (11.0, 12.0):
        make.at["now"] = now
        message = sources.PointCloud2(height=1, width=3)
        message.header.stamp, message.header.frame_id = rospy.Time(10), "laser"
        source._take(message)
        assert source.collect() == []
    assert source.ages().placed == 2.0 and "needs x, y and z" in source.ages().why
    assert "needs x, y and z" in lines[0] and "/scan" in lines[0] and len(lines) == 1


@pytest.mark.parametrize("increment", [float("nan"), float("inf"), 1e30])
def test_a_scan_whose_times_make_no_sense_is_one_line(make, lines, increment):
    """Each update of the costmap ended in a traceback."""
    source, _ = make(data_type="LaserScan")
    for stamp in (9.0, 9.1):
        message = LaserScan(ranges=[1.0, 1.0], range_max=5.0, time_increment=increment)
        message.header.stamp, message.header.frame_id = rospy.Time.from_sec(stamp), "laser"
        source._take(message)
        make.at["now"] += 1.0
        assert "time_increment" in source.ages().why
        assert source.collect() == []
    assert source.ages().placed == 2.0 and "time_increment" in lines[0] and len(lines) == 1
    message.time_increment = 0.0
    source._take(message)
    assert len(source.collect()) == 1 and source.ages().why == ""
