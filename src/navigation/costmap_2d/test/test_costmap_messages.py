"""Sensor messages in, grids out; no master."""


import numpy as np
import pytest
from geometry_msgs.msg import Point32, Quaternion, Transform, Vector3
from sensor_msgs.msg import LaserScan, PointCloud, PointCloud2, PointField

from costmap_2d import clouds
from costmap_2d.publishing import OCCUPANCIES

INF, NAN = float("inf"), float("nan")


def scan(*ranges, **fields):
    return LaserScan(ranges=ranges, angle_min=0.0, angle_increment=np.pi / 2, range_min=0.1,
                     range_max=5.0, **fields)


def cloud2(points):
    return PointCloud2(height=1, width=len(points), point_step=12, row_step=12 * len(points),
                       data=np.array(points, "<f4").tobytes(),
                       fields=[PointField(name, 4 * n, PointField.FLOAT32, 1)
                               for n, name in enumerate("xyz")])


def test_a_scan_becomes_points():
    points, when = clouds.points_of_scan(scan(1.0, 2.0, 3.0, time_increment=0.5), False)
    assert points == pytest.approx(np.array([[1, 0, 0], [0, 2, 0], [-3, 0, 0]]))
    assert when.tolist() == [0.0, 0.5, 1.0]


@pytest.mark.parametrize("inf_is_valid, expected", [(False, [2.0]), (True, [2.0, 4.9999])])
def test_ranges_that_count(inf_is_valid, expected):
    points, _ = clouds.points_of_scan(scan(NAN, 0.05, 2.0, 5.0, INF, -INF, 7.0), inf_is_valid)
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(expected)


@pytest.mark.parametrize("angle", ["angle_min", "angle_increment"])
def test_a_scan_that_leads_nowhere_is_refused(angle):
    message = scan(1.0, 2.0)
    setattr(message, angle, NAN)
    with pytest.raises(ValueError, match="leads nowhere"):
        clouds.points_of_scan(message, False)


@pytest.mark.parametrize("increment", [NAN, INF, 31.0])
def test_a_scan_that_never_ends_is_refused(increment):
    with pytest.raises(ValueError, match="time_increment"):
        clouds.points_of_scan(scan(1.0, 2.0, time_increment=increment), False)


def test_clouds_become_points():
    wanted = [[1.0, 2.0, 3.0], [-4.0, 5.5, 0.25]]
    message = PointCloud(points=[Point32(*point) for point in [*wanted, (NAN, 0, 0)]])
    points, when = clouds.timed_points(message, "PointCloud", False)
    assert points.tolist() == wanted and when.tolist() == [0.0, 0.0]
    assert clouds.timed_points(PointCloud(), "PointCloud", False)[0].shape == (0, 3)
    message = cloud2([*wanted, (0, INF, 0)])
    assert clouds.timed_points(message, "PointCloud2", False)[0].tolist() == wanted


def test_a_transform_turns_and_moves():
    turn = Quaternion(0.0, 0.0, np.sqrt(2), np.sqrt(2))  # 90 degrees about z, twice too long
    rotation, shift = clouds.rotation_and_translation(Transform(Vector3(1, 2, 3), turn))
    assert rotation @ [1, 0, 0] + shift == pytest.approx([1, 3, 3])


def test_a_moving_sensors_points_are_put_where_it_was():
    start, end = (np.eye(3), np.zeros(3)), (np.eye(3), np.array([1.0, 0, 0]))
    points = np.array([[0.0, 1, 0], [0, 1, 0], [0, 1, 0]])
    moved = clouds.placed(points, start, end, np.array([0.0, 0.1, 0.2]))
    assert moved[:, 0].tolist() == [0.0, 0.5, 1.0]


def test_costs_are_published_as_upstream_does():
    assert OCCUPANCIES[[0, 1, 2, 128, 252, 253, 254, 255]].tolist() == [
        0, 1, 1, 50, 98, 99, 100, -1]
