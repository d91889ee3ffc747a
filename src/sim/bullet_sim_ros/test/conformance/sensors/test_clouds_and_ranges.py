"""Ray sensors: block_laser, range, velodyne."""

import math

import numpy as np
import pytest
from sensor_models import eye, look
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud, PointCloud2, Range

VELODYNES = ("libgazebo_ros_velodyne_laser.so", "libgazebo_ros_velodyne_gpu_laser.so")


def test_block_laser(bench):
    # conforms: libgazebo_ros_block_laser.so, libgazebo_ros_block_laser.so/topicName
    # conforms: libgazebo_ros_block_laser.so/frameName, libgazebo_ros_block_laser.so/robotNamespace
    tags = """<topicName>cloud</topicName><frameName>lidar</frameName>
      <robotNamespace>r1</robotNamespace>"""
    up = "<samples>2</samples><min_angle>0</min_angle><max_angle>0.3</max_angle>"
    cloud, = look(bench, "/r1/cloud",
                  eye("libgazebo_ros_block_laser.so", tags, up=up), retro=7)
    assert bench.advertised()["/r1/cloud"] is PointCloud
    assert cloud.header.frame_id == "lidar"
    assert len(cloud.points) == 6
    assert [point.x for point in cloud.points] == pytest.approx([2.0] * 6, abs=1e-3)
    assert cloud.points[0].y == pytest.approx(-2 * math.tan(0.5), abs=1e-3)
    assert cloud.points[4].z == pytest.approx(2 * math.tan(0.3), abs=1e-3)
    assert cloud.channels[0].values == [7.0] * 6


def test_block_laser_by_default_and_its_noise(bench):
    # conforms: libgazebo_ros_block_laser.so/gaussianNoise
    across = "<samples>400</samples><min_angle>-3</min_angle><max_angle>3</max_angle>"
    model = eye("libgazebo_ros_block_laser.so", "<gaussianNoise>0.02</gaussianNoise>", across)
    cloud, = look(bench, "/world", model)
    assert cloud.header.frame_id == "world"
    reach = np.array([math.hypot(point.x, point.y) for point in cloud.points])
    met = reach < 4.5
    assert np.abs(reach[reach > 4.99] - 5.0).max() < 1e-4  # misses are not disturbed
    x = np.array([point.x for point in cloud.points])[met]
    assert x.std() == pytest.approx(0.02, rel=0.25)


def test_range(bench):
    # conforms: libgazebo_ros_range.so, libgazebo_ros_range.so/topicName
    # conforms: libgazebo_ros_range.so/frameName, libgazebo_ros_range.so/robotNamespace
    # conforms: libgazebo_ros_range.so/radiation, libgazebo_ros_range.so/fov
    tags = """<topicName>ir</topicName><frameName>front</frameName><fov>0.3</fov>
      <robotNamespace>/r1</robotNamespace><radiation>infrared</radiation>"""
    found, = look(bench, "/r1/ir", eye("libgazebo_ros_range.so", tags))
    assert isinstance(found, Range)
    assert (found.range, found.header.frame_id) == (pytest.approx(2.0, abs=1e-3), "front")
    assert (found.radiation_type, found.field_of_view) == (Range.INFRARED, 0.3)
    assert (found.min_range, found.max_range) == (0.1, 5.0)


def test_range_by_default(bench):
    # conforms: libgazebo_ros_range.so
    bench.spawn(eye("libgazebo_ros_range.so"))
    ranges = bench.listen("/range")
    bench.run(0.15)
    assert (ranges[0].range, ranges[0].header.frame_id) == (5.0, "world")
    assert (ranges[0].radiation_type, ranges[0].field_of_view) == (Range.ULTRASOUND, 0.05)


def test_noise_of_a_range_is_cut_at_the_far_end(bench):
    # conforms: libgazebo_ros_range.so/gaussianNoise
    model = eye("libgazebo_ros_range.so", "<gaussianNoise>3</gaussianNoise>", rate=100)
    told = np.array([found.range for found in look(bench, "/range", model, 1.0)])
    assert told.max() == 5.0
    assert told.std() > 0.5


@pytest.mark.parametrize("sensor, plugin, expected", [
    (100, 30, 25), (0, 30, 29), (20, 0, 20), (20, 50, 20)])
def test_a_range_is_thinned_to_its_own_rate(bench, sensor, plugin, expected):
    # conforms: libgazebo_ros_range.so/updateRate
    model = eye("libgazebo_ros_range.so", f"<updateRate>{plugin}</updateRate>", rate=sensor)
    assert len(look(bench, "/range", model, 1.0)) == expected


@pytest.mark.parametrize("plugin", VELODYNES)
def test_velodyne(bench, plugin):
    # conforms: libgazebo_ros_velodyne_laser.so, libgazebo_ros_velodyne_gpu_laser.so
    # conforms: libgazebo_ros_velodyne_laser.so/topicName, libgazebo_ros_velodyne_laser.so/frameName
    # conforms: libgazebo_ros_velodyne_laser.so/robotNamespace
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/topicName
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/frameName
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/robotNamespace
    tags = """<topicName>velodyne_points</topicName><frameName>velodyne</frameName>
      <robotNamespace>/r1</robotNamespace>"""
    up = "<samples>2</samples><min_angle>-0.2</min_angle><max_angle>0.2</max_angle>"
    cloud, = look(bench, "/r1/velodyne_points", eye(plugin, tags, up=up), retro=50)
    assert isinstance(cloud, PointCloud2)
    assert (cloud.header.frame_id, cloud.height, cloud.width) == ("r1/velodyne", 1, 6)
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "intensity", "ring", "time"]
    points = list(point_cloud2.read_points(cloud))
    assert [point[4] for point in points] == [0, 1] * 3
    assert points[2][:4] == pytest.approx((2, 0, -2 * math.tan(0.2), 50), abs=1e-3)
    assert points[5][:2] == pytest.approx((2, 2 * math.tan(0.5)), abs=1e-3)


def test_velodyne_by_default(bench):
    # conforms: libgazebo_ros_velodyne_laser.so
    cloud, = look(bench, "/points", eye(VELODYNES[0]))
    assert cloud.header.frame_id == "world"


@pytest.mark.parametrize("plugin", VELODYNES)
@pytest.mark.parametrize("tags, left", [
    ("<min_range>2.1</min_range>", 2), ("<max_range>2.1</max_range>", 1),
    ("<min_intensity>1</min_intensity>", 0), ("", 3)])
def test_what_a_velodyne_leaves_out(bench, plugin, tags, left):
    # conforms: libgazebo_ros_velodyne_laser.so/min_range, libgazebo_ros_velodyne_laser.so/max_range
    # conforms: libgazebo_ros_velodyne_laser.so/min_intensity
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/min_range
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/max_range
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/min_intensity
    cloud, = look(bench, "/points", eye(plugin, tags))
    assert (cloud.width, cloud.is_dense) == (left, True)


@pytest.mark.parametrize("plugin", VELODYNES)
def test_an_organised_cloud_keeps_the_places_of_misses(bench, plugin):
    # conforms: libgazebo_ros_velodyne_laser.so/organize_cloud
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/organize_cloud
    across = "<samples>3</samples><min_angle>-3</min_angle><max_angle>3</max_angle>"
    model = eye(plugin, "<organize_cloud>true</organize_cloud>", across)
    cloud, = look(bench, "/points", model)
    assert (cloud.height, cloud.width, cloud.is_dense) == (3, 1, False)
    seen = [not math.isnan(point[0]) for point in point_cloud2.read_points(cloud)]
    assert seen == [False, True, False]


@pytest.mark.parametrize("plugin", VELODYNES)
def test_noise_of_a_velodyne(bench, plugin):
    # conforms: libgazebo_ros_velodyne_laser.so/gaussianNoise
    # conforms: libgazebo_ros_velodyne_gpu_laser.so/gaussianNoise
    across = "<samples>500</samples><min_angle>-0.01</min_angle><max_angle>0.01</max_angle>"
    model = eye(plugin, "<gaussianNoise>0.03</gaussianNoise>", across)
    cloud, = look(bench, "/points", model)
    x = np.array([point[0] for point in point_cloud2.read_points(cloud)])
    assert x.std() == pytest.approx(0.03, rel=0.15)
