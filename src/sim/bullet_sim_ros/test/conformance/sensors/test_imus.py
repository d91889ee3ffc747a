"""libgazebo_ros_imu.so, libgazebo_ros_imu_sensor.so, and SDF's <imu>."""

import itertools
import math

import numpy as np
import pytest
import rospy
from sensor_models import turn, xyz
from sensor_msgs.msg import Imu
from std_srvs.srv import EmptyResponse

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist

DIAGONAL = [0, 4, 8]


def body(inside: str = "", plugin: str = "", name: str = "thing") -> str:
    return f"""<model name="{name}"><link name="base"><inertial><mass>1</mass></inertial>
      <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
      {inside}</link>{plugin}</model>"""


def imu(tags: str) -> str:
    return body(plugin=f'<plugin name="i" filename="libgazebo_ros_imu.so">{tags}</plugin>')


def imu_sensor(tags: str, sdf: str = "", rate: float = 100, pose: str = "0 0 0 0 0 0") -> str:
    return body(f"""<sensor name="s" type="imu"><pose>{pose}</pose>
      <update_rate>{rate}</update_rate>{sdf}
      <plugin name="p" filename="libgazebo_ros_imu_sensor.so">{tags}</plugin></sensor>""")


def standing(bench, model: str, topic: str, seconds: float = 0.2) -> list:
    """What a sensor tells after the body has come to rest on the ground."""
    bench.spawn(model, Pose((0, 0, 0.5)))
    bench.run(0.3)
    messages = bench.listen(topic)
    bench.run(seconds)
    return messages


# --- the model plugin

def test_imu_without_gravity_in_the_links_axes(bench):
    # conforms: libgazebo_ros_imu.so/topicName, libgazebo_ros_imu.so/bodyName
    # conforms: libgazebo_ros_imu.so/frameName, libgazebo_ros_imu.so/updateRate
    # conforms: libgazebo_ros_imu.so/robotNamespace, libgazebo_ros_imu.so
    tags = """<bodyName>base</bodyName><topicName>imu</topicName><frameName>imu_link</frameName>
      <updateRate>50</updateRate><robotNamespace>/r1</robotNamespace>"""
    model = bench.spawn(imu(tags), Pose.from_xyz_rpy((0, 0, 9), (math.pi / 2, 0, 0)))
    model.set_twist(Twist((0, 0, 0), (0, 0, 1.0)))
    readings = bench.listen("/r1/imu")
    bench.run(0.2)
    assert len(readings) == 10
    last = readings[-1]
    assert last.header.frame_id == "imu_link"
    assert xyz(last.linear_acceleration) == pytest.approx([0, -9.8, 0], abs=0.01)  # falling
    assert xyz(last.angular_velocity) == pytest.approx([0, 1, 0], abs=1e-3)
    assert last.orientation_covariance == last.linear_acceleration_covariance == [0.0] * 9


def test_imu_by_default(bench):
    # conforms: libgazebo_ros_imu.so/serviceName, libgazebo_ros_imu.so/updateRate
    readings = standing(bench, imu("<bodyName>base</bodyName>"), "/default_imu", 0.05)
    assert len(readings) == 50
    assert readings[0].header.frame_id == "base"
    assert xyz(readings[-1].linear_acceleration) == pytest.approx([0, 0, 0], abs=0.2)
    assert isinstance(bench.call("/default_imu"), EmptyResponse)


def test_imu_rates_are_rounded_to_steps(bench):
    # conforms: libgazebo_ros_imu.so/updateRate
    readings = standing(bench, imu("<bodyName>base</bodyName><updateRate>30</updateRate>"),
                        "/default_imu", 1.0)
    gaps = {round((b.header.stamp - a.header.stamp).to_sec() * 1000)
            for a, b in itertools.pairwise(readings)}
    assert gaps == {34}


def test_imu_services_topics_and_noise(bench):
    # conforms: libgazebo_ros_imu.so/serviceName, libgazebo_ros_imu.so/gaussianNoise
    # conforms: libgazebo_ros_imu.so/rpyOffset, libgazebo_ros_imu.so/topicName
    tags = """<bodyName>base</bodyName><topicName>imu</topicName><serviceName>zero</serviceName>
      <gaussianNoise>0.1</gaussianNoise><rpyOffset>0 0 1.5707963</rpyOffset>"""
    readings = standing(bench, imu(tags), "/imu", 0.3)
    assert isinstance(bench.call("/zero"), EmptyResponse)
    rates = np.array([xyz(reading.angular_velocity) for reading in readings])
    assert rates.std() == pytest.approx(0.1, rel=0.1)
    accelerations = np.array([xyz(reading.linear_acceleration) for reading in readings])
    assert accelerations.std() == pytest.approx(0.1, rel=0.1)
    assert turn(readings[0].orientation) == pytest.approx([0, 0, 0.7071, 0.7071], abs=1e-3)
    for covariance in (readings[0].orientation_covariance,
                       readings[0].angular_velocity_covariance,
                       readings[0].linear_acceleration_covariance):
        assert np.array(covariance)[DIAGONAL] == pytest.approx([0.01] * 3)


def test_imu_of_another_models_link_and_without_a_topic(bench, caplog):
    # conforms: libgazebo_ros_imu.so/bodyName, libgazebo_ros_imu.so/topicName
    bench.spawn(body(name="other"), Pose((3, 0, 0.5)))
    carrier = """<model name="m"><link name="x"/><plugin name="i" filename="libgazebo_ros_imu.so">
      <bodyName>other::base</bodyName><topicName>imu</topicName></plugin></model>"""
    readings = standing(bench, carrier, "/imu", 0.01)
    assert readings[-1].header.frame_id == "base"
    before = set(bench.advertised())
    bench.spawn(imu("<bodyName>base</bodyName><topicName/>"))
    assert set(bench.advertised()) == before
    bench.delete("thing")
    bench.spawn(imu("<bodyName>nope</bodyName>"))
    assert "no link of model thing named 'nope'" in caplog.text


# --- the sensor plugin

def test_imu_sensor_feels_gravity_in_its_own_axes(bench):
    # conforms: libgazebo_ros_imu_sensor.so, libgazebo_ros_imu_sensor.so/topicName
    # conforms: libgazebo_ros_imu_sensor.so/frameName, libgazebo_ros_imu_sensor.so/robotNamespace
    tags = """<topicName>imu</topicName><frameName>imu_link</frameName>
      <robotNamespace>/r1</robotNamespace><updateRateHZ>100</updateRateHZ>"""
    readings = standing(bench, imu_sensor(tags, pose="0 0 0 1.5707963 0 0"), "/r1/imu")
    last = readings[-1]
    assert isinstance(last, Imu)
    assert last.header.frame_id == "imu_link"
    assert xyz(last.linear_acceleration) == pytest.approx([0, 9.8, 0], abs=0.02)
    assert turn(last.orientation) == pytest.approx([0.7071, 0, 0, 0.7071], abs=1e-3)


def test_imu_sensor_feels_the_turn_where_it_is_mounted(bench):
    # conforms: sdf sensor/pose
    model = bench.spawn(imu_sensor(
        "<frameName>f</frameName><updateRateHZ>0</updateRateHZ>", rate=0, pose="0.5 0 0 0 0 0"),
        Pose((0, 0, 9)))
    model.set_twist(Twist((0, 0, 0), (0, 0, 2.0)))
    readings = bench.listen("/thing/imu_data")
    bench.run(0.05)
    acceleration = xyz(readings[-1].linear_acceleration)
    assert acceleration == pytest.approx([-2.0 ** 2 * 0.5, 0, 0], abs=0.05)  # towards the middle
    assert xyz(readings[-1].angular_velocity) == pytest.approx([0, 0, 2], abs=1e-3)


@pytest.mark.parametrize("tag, topic", [
    ("", "/thing/imu_data"), ("<robotNamespace/>", "/imu_data"),
    ("<robotNamespace>/</robotNamespace>", "/imu_data")])
def test_namespaces_of_the_imu_sensor(bench, tag, topic):
    # conforms: libgazebo_ros_imu_sensor.so/robotNamespace
    bench.spawn(imu_sensor(f"<frameName>f</frameName>{tag}"))
    assert topic in bench.advertised()


@pytest.mark.parametrize("tag, rate, expected", [
    ("", 100, 1), ("<updateRateHZ>30</updateRateHZ>", 100, 25),
    ("<updateRateHZ>200</updateRateHZ>", 50, 50), ("<updateRateHZ>30</updateRateHZ>", 0, 29)])
def test_rates_of_the_imu_sensor(bench, tag, rate, expected):
    # conforms: libgazebo_ros_imu_sensor.so/updateRateHZ
    bench.spawn(imu_sensor(f"<frameName>f</frameName>{tag}", rate=rate), Pose((0, 0, 0.5)))
    readings = bench.listen("/thing/imu_data")
    bench.run(1.0)
    assert len(readings) == expected


def test_an_imu_sensor_needs_a_frame(bench, caplog):
    # conforms: libgazebo_ros_imu_sensor.so/frameName
    bench.spawn(imu_sensor(""))
    assert "it needs a <frameName>" in caplog.text
    assert "/thing/imu_data" not in bench.advertised()


@pytest.mark.parametrize("tag, expected", [
    ("", [0, 0, 0.7071, 0.7071]),
    ("<initialOrientationAsReference>true</initialOrientationAsReference>", [0, 0, 0, 1]),
    ("<rpyOffset>0 0 -1.5707963</rpyOffset>", [0, 0, 0, 1])])
def test_orientation_of_the_imu_sensor(bench, tag, expected):
    # conforms: libgazebo_ros_imu_sensor.so/initialOrientationAsReference
    # conforms: libgazebo_ros_imu_sensor.so/rpyOffset
    model = imu_sensor(f"<frameName>f</frameName><updateRateHZ>50</updateRateHZ>{tag}")
    bench.spawn(model, Pose.from_xyz_rpy((0, 0, 0.5), (0, 0, math.pi / 2)))
    readings = bench.listen("/thing/imu_data")
    bench.run(0.1)
    assert turn(readings[-1].orientation) == pytest.approx(expected, abs=1e-3)


def test_noise_of_the_imu_sensors_plugin(bench):
    # conforms: libgazebo_ros_imu_sensor.so/gaussianNoise
    tags = """<frameName>f</frameName><updateRateHZ>0</updateRateHZ>
      <gaussianNoise>0.1</gaussianNoise>"""
    readings = standing(bench, imu_sensor(tags, rate=0), "/thing/imu_data", 0.3)
    table = np.array([[*turn(r.orientation), *xyz(r.angular_velocity),
                       *xyz(r.linear_acceleration)] for r in readings])
    assert table.std(axis=0) == pytest.approx(np.full(10, 0.1), rel=0.2)
    assert np.array(readings[0].orientation_covariance)[DIAGONAL] == pytest.approx([0.01] * 3)


def noisy(bench, sdf: str) -> np.ndarray:
    """(n, 6) rates and accelerations of a standing body."""
    tags = "<frameName>f</frameName><updateRateHZ>0</updateRateHZ>"
    readings = standing(bench, imu_sensor(tags, f"<imu>{sdf}</imu>", rate=0), "/thing/imu_data",
                        0.3)
    return np.array([[*xyz(r.angular_velocity), *xyz(r.linear_acceleration)]
                     for r in readings])


def axis(name: str, noise: str) -> str:
    return f'<{name}><noise type="gaussian">{noise}</noise></{name}>'


def test_noise_by_axis(bench):
    # conforms: sdf sensor/imu/angular_velocity, sdf sensor/imu/linear_acceleration
    table = noisy(bench, f"""
      <angular_velocity>{axis("x", "<stddev>0.1</stddev>")}</angular_velocity>
      <linear_acceleration>{axis("y", "<mean>0.5</mean>")}
        {axis("z", "<bias_mean>0.25</bias_mean>")}</linear_acceleration>""")
    assert table[:, 0].std() == pytest.approx(0.1, rel=0.15)
    assert table[:, 1:3].std() < 0.01
    assert table[:, 4].mean() == pytest.approx(0.5, abs=0.02)
    assert abs(table[:, 5].mean() - 9.8) == pytest.approx(0.25, abs=0.02)


def test_noise_as_sdf_1_4_has_it(bench):
    # conforms: sdf sensor/imu/noise
    table = noisy(bench, """<noise><type>gaussian</type><rate><stddev>0.2</stddev></rate>
      <accel><mean>1</mean></accel></noise>""")
    assert table[:, :3].std(axis=0) == pytest.approx([0.2] * 3, rel=0.2)
    assert table[:, 3:].mean(axis=0) == pytest.approx([1, 1, 10.8], abs=0.02)


def test_stamps_begin_again_after_a_reset(bench):
    # conforms: libgazebo_ros_imu_sensor.so
    bench.spawn(imu_sensor("<frameName>f</frameName><updateRateHZ>100</updateRateHZ>"),
                Pose((0, 0, 5)))
    readings = bench.listen("/thing/imu_data")
    bench.run(0.5)
    bench.call("/gazebo/reset_simulation")
    readings.clear()
    bench.run(0.02)
    assert readings[0].header.stamp == rospy.Time(0, 10_000_000)
    assert xyz(readings[0].linear_acceleration) == pytest.approx([0, 0, 9.8], abs=1e-6)
