"""Ray sensors and their laser plugins: SDF's <ray> and <noise>, laser, gpu_laser."""

import math

import numpy as np
import pytest
import rospy
from sensor_models import ACROSS, eye, look
from sensor_msgs.msg import LaserScan

from bullet_sim.sensors.laser import fewer_rays

LASERS = ("libgazebo_ros_laser.so", "libgazebo_ros_gpu_laser.so")
OTHERS = ("libgazebo_ros_block_laser.so", "libgazebo_ros_range.so")
VELODYNES = ("libgazebo_ros_velodyne_laser.so", "libgazebo_ros_velodyne_gpu_laser.so")


@pytest.mark.parametrize("plugin", LASERS)
def test_laser_with_its_tags(bench, plugin):
    # conforms: libgazebo_ros_laser.so/topicName, libgazebo_ros_laser.so/frameName
    # conforms: libgazebo_ros_laser.so/robotNamespace, libgazebo_ros_gpu_laser.so/topicName
    # conforms: libgazebo_ros_gpu_laser.so/frameName, libgazebo_ros_gpu_laser.so/robotNamespace
    # conforms: sdf collision/laser_retro, sdf sensor/ray/range
    tags = """<topicName>scan</topicName><frameName>base_scan</frameName>
      <robotNamespace>/r1</robotNamespace>"""
    scan, = look(bench, "/r1/scan", eye(plugin, tags), retro=120)
    assert bench.advertised()["/r1/scan"] is LaserScan
    assert (scan.header.frame_id, scan.header.stamp) == ("base_scan", rospy.Time(0, 100_000_000))
    assert scan.ranges == pytest.approx([2 / math.cos(0.5), 2, 2 / math.cos(0.5)], abs=1e-3)
    assert scan.intensities == [120.0] * 3
    assert (scan.angle_min, scan.angle_max, scan.angle_increment) == (-0.5, 0.5, 0.5)
    assert (scan.range_min, scan.range_max) == (0.1, 5.0)
    assert (scan.time_increment, scan.scan_time) == (0.0, 0.0)


@pytest.mark.parametrize("plugin", LASERS)
def test_laser_without_tags(bench, plugin):
    # conforms: libgazebo_ros_laser.so, libgazebo_ros_gpu_laser.so
    scan, = look(bench, "/world", eye(plugin))
    assert scan.header.frame_id == "world"


@pytest.mark.parametrize("tag, topic", [
    ("<robotNamespace/>", "/eye/scan"), ("<robotNamespace>/</robotNamespace>", "/scan"),
    ("", "/scan")])
def test_an_empty_namespace_of_a_laser_is_the_models_name(bench, tag, topic):
    # conforms: libgazebo_ros_laser.so/robotNamespace
    bench.spawn(eye(LASERS[0], f"{tag}<topicName>scan</topicName>"))
    assert topic in bench.advertised()


def test_an_empty_topic_is_none(bench):
    # conforms: libgazebo_ros_laser.so/topicName, libgazebo_ros_block_laser.so/topicName
    # conforms: libgazebo_ros_range.so/topicName, libgazebo_ros_velodyne_laser.so/topicName
    before = bench.advertised()
    for plugin in (*LASERS, *VELODYNES, *OTHERS):
        bench.spawn(eye(plugin, "<topicName/>"))
        assert bench.advertised() == before
        bench.run(0.11)
        bench.delete("eye")


def test_tf_prefix_is_searched_upwards_by_lasers_and_exact_for_the_others(bench):
    # conforms: tf_prefix of sensors
    bench.graph.parameters.update({"/tf_prefix": "top", "/r2/tf_prefix": "own"})
    tags = "<robotNamespace>/{ns}</robotNamespace><topicName>t</topicName><frameName>f</frameName>"
    found = {}
    for plugin in (*LASERS, *OTHERS):
        for namespace in ("r1", "r2"):
            message, = look(bench, f"/{namespace}/t", eye(plugin, tags.format(ns=namespace)))
            found.setdefault(plugin, []).append(message.header.frame_id)
            bench.delete("eye")
            bench.delete("wall")
    assert list(found.values()) == [["top/f", "own/f"]] * 2 + [["f", "own/f"]] * 2


def test_infinities(bench):
    # conforms: sdf sensor/ray/range
    near = "<range><min>2.5</min><max>5</max></range>"
    behind = "<samples>2</samples><min_angle>0</min_angle><max_angle>3.14159</max_angle>"
    scan, = look(bench, "/world", eye(LASERS[0], across=behind, ray=near))
    assert scan.ranges[1] == math.inf
    touching = eye(LASERS[0], across="<samples>1</samples>",
                     ray="<range><min>2.0</min><max>5</max></range>")
    bench.delete("eye")
    bench.delete("wall")
    scan, = look(bench, "/world", touching)
    assert scan.ranges[0] == -math.inf


def test_samples_resolution_and_rows(bench):
    # conforms: sdf sensor/ray/scan/horizontal/samples, sdf sensor/ray/scan/horizontal/resolution
    # conforms: sdf sensor/ray/scan/horizontal/min_angle, sdf sensor/ray/scan/vertical/samples
    # conforms: sdf sensor/ray/scan/horizontal/max_angle, sdf sensor/ray/scan/vertical/min_angle
    # conforms: sdf sensor/ray/scan/vertical/max_angle, sdf sensor/ray/scan/vertical/resolution
    up = """<samples>4</samples><resolution>0.5</resolution><min_angle>-0.3</min_angle>
      <max_angle>0.2</max_angle>"""
    across = ACROSS + "<resolution>2</resolution>"
    scan, = look(bench, "/world", eye(LASERS[0], across=across, up=up))
    assert len(scan.ranges) == 2 * 6
    assert scan.angle_increment == pytest.approx(1.0 / 5)
    slant = [2 / (math.cos(across) * math.cos(up))
             for up in (-0.3, 0.2) for across in np.linspace(-0.5, 0.5, 6)]
    assert scan.ranges == pytest.approx(slant, abs=1e-3)


def test_one_ray_looks_ahead(bench):
    # conforms: sdf sensor/ray/scan/horizontal/samples
    across = "<samples>1</samples><min_angle>0.8</min_angle><max_angle>0.8</max_angle>"
    scan, = look(bench, "/world", eye(LASERS[0], across=across))
    assert scan.ranges == pytest.approx([2.0], abs=1e-3)


def test_a_laser_works_at_its_sensors_rate_and_only_while_somebody_listens(bench):
    # conforms: sdf sensor/update_rate, libgazebo_ros_laser.so
    scans = look(bench, "/world", eye(LASERS[0], rate=30), seconds=1.0)
    assert [round(scan.header.stamp.to_sec() * 1000) for scan in scans[:3]] == [34, 67, 100]
    assert len(scans) == 30
    bench.delete("eye")
    bench.spawn(eye(LASERS[0], rate=0))
    asleep = bench.listen("/world", listeners=0)
    bench.run(0.05)
    assert not asleep
    scans = bench.listen("/world")
    bench.run(0.05)
    assert len(scans) == 50


def test_of_too_many_rays_some_are_cast_over_the_same_angles(bench, caplog):
    # conforms: sdf sensor/ray/scan/horizontal/samples, sdf sensor/ray/scan/vertical/samples
    angles = "<samples>{}</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle>"
    scan, = look(bench, "/world", eye(LASERS[0], across=angles.format(99_999_999),
                                      up=angles.format(2)))
    assert ("sensor s of eye::l has 99999999 x 2 rays, but at most 100000 are cast: "
            "50000 x 2 over the same angles are used") in caplog.text
    assert len(scan.ranges) == 100_000
    assert (scan.angle_min, scan.angle_max) == (-0.5, 0.5)
    for asked, cast in (((4000, 64), (1562, 64)), ((2, 10 ** 9), (2, 50_000)),
                        ((10 ** 9, 10 ** 9), (316, 316))):
        assert fewer_rays(*asked) == cast


def noisy(bench, noise: str) -> np.ndarray:
    across = "<samples>1000</samples><min_angle>-0.01</min_angle><max_angle>0.01</max_angle>"
    ray = f"<range><min>0.1</min><max>5</max></range><noise>{noise}</noise>"
    scan, = look(bench, "/world", eye(LASERS[0], across=across, ray=ray))
    return np.array(scan.ranges)


def test_noise_of_rays(bench):
    # conforms: sdf noise/type, sdf noise/mean, sdf noise/stddev
    ranges = noisy(bench, "<type>gaussian</type><mean>0.2</mean><stddev>0.05</stddev>")
    assert ranges.mean() == pytest.approx(2.2, abs=0.01)
    assert ranges.std() == pytest.approx(0.05, rel=0.1)


def test_no_noise(bench):
    # conforms: sdf noise/type
    assert noisy(bench, "<type>none</type><stddev>0.05</stddev>").std() < 1e-3


def test_bias_is_drawn_once_with_either_sign(bench):
    # conforms: sdf noise/bias_mean, sdf noise/bias_stddev
    same = noisy(bench, "<type>gaussian</type><bias_mean>0.3</bias_mean>") - 2.0
    assert np.abs(same) == pytest.approx(np.full(1000, 0.3), abs=1e-3)
    bench.delete("eye")
    bench.delete("wall")
    drawn = noisy(bench, "<type>gaussian</type><bias_stddev>0.3</bias_stddev>") - 2.0
    assert drawn.std() < 1e-3 < np.abs(drawn).min()


def test_quantised_noise(bench):
    # conforms: sdf noise/precision
    ranges = noisy(bench, """<type>gaussian_quantized</type><stddev>0.1</stddev>
      <precision>0.05</precision>""")
    assert ranges / 0.05 == pytest.approx(np.round(ranges / 0.05), abs=1e-4)
    assert len(set(ranges.tolist())) > 3


def test_noise_stays_within_the_range(bench):
    # conforms: sdf noise/mean
    assert noisy(bench, "<type>gaussian</type><mean>9</mean>").tolist() == [5.0] * 1000
