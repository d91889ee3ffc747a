"""When a sensor's messages count, with a tf that is made up; no master."""

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import Point32, Transform
from sensor_msgs.msg import LaserScan, PointCloud

from costmap_2d import sources
from costmap_2d.settings import table
from nav_nodes.complaints import Complaints


class Frames:
    """The sensor moves with 1 m/s along x, 0.3 m above the floor; known up to `until`, s."""

    def __init__(self):
        self.until = 100.0

    def find(self, _parent, child, stamp):
        if stamp.to_sec() > self.until:
            return None
        found = Transform()
        found.translation.x = stamp.to_sec() + (child == "elsewhere") * 10
        found.translation.z = 0.3
        found.rotation.w = 1.0
        return found


@pytest.fixture
def make(monkeypatch):
    """A source of these settings and the frames that it goes by, at time 10 s."""
    at = {"now": 10.0}
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time.from_sec(at["now"]))

    def make_source(**settings):
        values = {entry.name: entry.default for entry in table("source")}
        frames = Frames()
        source = sources.Source({**values, "topic": "scan", **settings}, "map", frames,
                                Complaints())
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
    assert source.silence() == ("PointCloud on /scan", 1.5)
    source._take(cloud(11.0))
    assert source.silence()[1] == 0.0


def test_a_damaged_cloud_is_one_line_and_frees_nothing(make, monkeypatch):
    lines = []
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda _period, text, *values: lines.append(
        text % values))
    source, _ = make(data_type="PointCloud2")
    source._take(sources.PointCloud2(height=1, width=3))
    assert [len(seen.points) for seen in source.collect()] == [0]
    assert "needs x, y and z" in lines[0] and "/scan" in lines[0]
