"""libhector_gazebo_ros_imu.so: axes, offsets, biases, services."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Vector3
from sensor_models import hector, take, turn, xyz
from sensor_msgs.msg import Imu

from bullet_sim.pose import Pose, rpy_from_quaternion
from bullet_sim.twist import Twist


def test_imu_axes(bench):
    # conforms: libhector_gazebo_ros_imu.so
    text = """<model name="bot"><link name="base"><inertial><mass>1</mass></inertial></link>
      <plugin name="p" filename="libhector_gazebo_ros_imu.so"/></model>"""
    body = bench.spawn(text, Pose.from_xyz_rpy((0, 0, 9), (math.pi / 2, 0, 0)))
    body.set_twist(Twist((0, 0, 0), (0, 0, 1.0)))
    readings = bench.listen("/imu")
    bench.run(0.02)
    assert isinstance(readings[-1], Imu)
    assert xyz(readings[0].linear_acceleration) == pytest.approx([0, 9.8, 0], abs=1e-2)
    assert xyz(readings[-1].linear_acceleration) == pytest.approx([0, 0, 0], abs=1e-2)  # falling
    assert xyz(readings[-1].angular_velocity) == pytest.approx([0, 1, 0], abs=1e-2)


def test_imu_offset_noise_and_covariances(bench):
    # conforms: libhector_gazebo_ros_imu.so/rpyOffset, libhector_gazebo_ros_imu.so/gaussianNoise
    tags = """<rpyOffset>0 0 1.5707963</rpyOffset><gaussianNoise>0.1</gaussianNoise>
      <yawGaussianNoise>0.3</yawGaussianNoise>"""
    readings = take(bench, "/imu", hector("imu", tags))
    orientation = readings[-1].orientation
    assert (orientation.z, orientation.w) == pytest.approx((0.7071, 0.7071), abs=1e-3)
    last = readings[-1]
    diagonal = [0, 4, 8]
    assert np.array(last.angular_velocity_covariance)[diagonal] == pytest.approx([0.01] * 3)
    assert np.array(last.linear_acceleration_covariance)[diagonal] == pytest.approx([0.01] * 3)
    level = 0.01 / 9.8 ** 2
    assert np.array(last.orientation_covariance)[diagonal] == pytest.approx([level, level, 0.09])
    rates = np.array([xyz(reading.angular_velocity) for reading in readings])
    assert rates.std() == pytest.approx(0.1, rel=0.2)


@pytest.mark.parametrize("prefix", ["yaw", "heading"])
def test_a_bias_misleads_the_orientation(bench, prefix):
    # conforms: libhector_gazebo_ros_imu.so/yawOffset, libhector_gazebo_ros_imu.so/headingOffset
    tags = f"<accelOffset>0 0.98 0</accelOffset><{prefix}Offset>0.4</{prefix}Offset>"
    readings = take(bench, "/imu", hector("imu", tags))
    roll, pitch, yaw = rpy_from_quaternion(turn(readings[-1].orientation))
    assert yaw == pytest.approx(0.4, abs=1e-3)
    assert math.hypot(roll, pitch) == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize("prefix", ["yaw", "heading"])
def test_drift_and_noise_of_the_yaw(bench, prefix):
    # conforms: libhector_gazebo_ros_imu.so/yawDrift, libhector_gazebo_ros_imu.so/headingDrift
    # conforms: libhector_gazebo_ros_imu.so/yawDriftFrequency
    # conforms: libhector_gazebo_ros_imu.so/headingDriftFrequency
    # conforms: libhector_gazebo_ros_imu.so/yawGaussianNoise
    # conforms: libhector_gazebo_ros_imu.so/headingGaussianNoise
    tags = f"""<{prefix}Drift>0.2</{prefix}Drift><{prefix}GaussianNoise>0.3</{prefix}GaussianNoise>
      <{prefix}DriftFrequency>60</{prefix}DriftFrequency>"""
    readings = take(bench, "/imu", hector("imu", tags), 2.0)
    yaws = 2 * np.array([reading.orientation.z for reading in readings])
    assert yaws.std() == pytest.approx(0.2, rel=0.4)
    assert readings[0].orientation_covariance[8] == pytest.approx(0.09)


def test_biases_are_told_and_set(bench):
    # conforms: libhector_gazebo_ros_imu.so/biasTopicName, libhector_gazebo_ros_imu.so/serviceName
    # conforms: TOPIC/set_accel_bias of hector's IMU, TOPIC/set_rate_bias of hector's IMU
    biases = take(bench, "/imu/bias", hector("imu", "<accelOffset>0.5</accelOffset>"))
    assert xyz(biases[-1].linear_acceleration) == [0.5] * 3
    bench.call("/imu/set_accel_bias", bias=Vector3(0.1, 0.2, 0.3))
    bench.call("/imu/set_rate_bias", bias=Vector3(0.4, 0.5, 0.6))
    bench.run(0.01)
    assert xyz(biases[-1].linear_acceleration) == pytest.approx([0.6, 0.7, 0.8], abs=1e-3)
    assert xyz(biases[-1].angular_velocity) == pytest.approx([0.4, 0.5, 0.6], abs=1e-3)
    bench.call("/imu/calibrate")
    bench.run(0.01)
    assert xyz(biases[-1].angular_velocity) == [0.0] * 3
    bench.delete("bot")
    bench.spawn(hector("imu", """<biasTopicName>b</biasTopicName><serviceName>c</serviceName>
      <topicName>i</topicName>"""))
    assert {"/i", "/b"} <= set(bench.advertised())
    assert {"/c", "/i/set_accel_bias"} <= set(bench.graph.services)
    bench.delete("bot")
    before = set(bench.advertised())
    bench.spawn(hector("imu", "<topicName/>"))
    assert set(bench.advertised()) == before
