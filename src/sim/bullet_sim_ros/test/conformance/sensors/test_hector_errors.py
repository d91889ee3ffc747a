"""hector_gazebo's sensor plugins: names, rates, error models and reconfiguration."""

import math

import numpy as np
import pytest
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter
from sensor_models import hector, take, xyz
from sensor_msgs.msg import NavSatStatus

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist


def reconfigure(bench, namespace: str, doubles=None, bools=None) -> None:
    bench.call(f"{namespace}/set_parameters", config=Config(
        doubles=[DoubleParameter(*pair) for pair in (doubles or {}).items()],
        bools=[BoolParameter(*pair) for pair in (bools or {}).items()]))


@pytest.mark.parametrize("kind, topic", [
    ("imu", "/imu"), ("gps", "/fix"), ("magnetic", "/magnetic"), ("baro", "/pressure_height")])
def test_defaults_names_and_link(bench, kind, topic):
    # conforms: libhector_gazebo_ros_imu.so, libhector_gazebo_ros_gps.so
    # conforms: libhector_gazebo_ros_magnetic.so, libhector_gazebo_ros_baro.so
    # conforms: libhector_gazebo_ros_imu.so/bodyName
    # conforms: libhector_gazebo_ros_magnetic.so/bodyName, libhector_gazebo_ros_baro.so/bodyName
    # conforms: libhector_gazebo_ros_imu.so/frameId, libhector_gazebo_ros_gps.so/frameId
    # conforms: libhector_gazebo_ros_magnetic.so/frameId, libhector_gazebo_ros_baro.so/frameId
    # conforms: libhector_gazebo_ros_imu.so/topicName, libhector_gazebo_ros_gps.so/topicName
    # conforms: libhector_gazebo_ros_magnetic.so/topicName, libhector_gazebo_ros_baro.so/topicName
    # conforms: libhector_gazebo_ros_imu.so/robotNamespace
    # conforms: libhector_gazebo_ros_gps.so/robotNamespace
    # conforms: libhector_gazebo_ros_magnetic.so/robotNamespace
    # conforms: libhector_gazebo_ros_baro.so/robotNamespace
    plain = take(bench, topic, hector(kind))[-1]
    assert plain.header.frame_id == ("world" if kind == "gps" else "base")
    bench.delete("bot")
    named = take(bench, "/r1/told", hector(kind, """<robotNamespace>/r1</robotNamespace>
      <topicName>told</topicName><bodyName>mast</bodyName>"""))[-1]
    assert named.header.frame_id == ("world" if kind == "gps" else "mast")
    bench.delete("bot")
    framed = take(bench, topic, hector(kind, "<frameId>/my_frame</frameId>"))[-1]
    assert framed.header.frame_id == "my_frame"
    bench.delete("bot")


@pytest.mark.parametrize("kind, topic", [("imu", "/imu"), ("gps", "/fix")])
def test_a_second_robot_in_the_same_namespace_is_not_lost(bench, caplog, kind, topic):
    # conforms: libhector_gazebo_ros_imu.so, libhector_gazebo_ros_gps.so
    bench.spawn(hector(kind))
    bench.spawn(hector(kind), name="second")
    assert "dynamic_reconfigure is not offered: service [" in caplog.text
    assert len(bench.graph.topics[topic].publishers) == 2
    bench.delete("bot")
    told = bench.listen(topic)
    bench.run(0.3)
    assert told


@pytest.mark.parametrize("kind, topic, usual", [
    ("imu", "/imu", 1000), ("gps", "/fix", 4), ("magnetic", "/magnetic", 1000),
    ("baro", "/altimeter", 1000)])
def test_rates(bench, kind, topic, usual):
    # conforms: libhector_gazebo_ros_imu.so/updateRate, libhector_gazebo_ros_gps.so/updateRate
    # conforms: libhector_gazebo_ros_magnetic.so/updateRate, libhector_gazebo_ros_baro.so/updateRate
    # conforms: libhector_gazebo_ros_imu.so/updatePeriod, libhector_gazebo_ros_gps.so/updatePeriod
    # conforms: libhector_gazebo_ros_magnetic.so/updatePeriod
    # conforms: libhector_gazebo_ros_baro.so/updatePeriod
    counts = []
    for tags in ("", "<updateRate>30</updateRate>",
                 "<updateRate>30</updateRate><updatePeriod>0.1</updatePeriod>"):
        counts.append(len(take(bench, topic, hector(kind, tags), 1.0)))
        bench.delete("bot")
    assert counts == [usual, 30, 10]


ERRORS = {"imu": ("accel", "/imu", lambda m: xyz(m.linear_acceleration), (0, 0, 9.8)),
          "rate": ("rate", "/imu", lambda m: xyz(m.angular_velocity), (0, 0, 0)),
          "velocity": ("velocity", "/fix_velocity", lambda m: xyz(m.vector), (0, 0, 0)),
          "magnetic": ("", "/magnetic", lambda m: xyz(m.vector), (0.5, 0, -math.sqrt(0.75))),
          "baro": ("", "/pressure_height", lambda m: [m.point.z], (2.0,))}
LIBRARIES = {"rate": "imu", "velocity": "gps"}


@pytest.mark.parametrize("name", ERRORS)
def test_error_models(bench, name):
    # conforms: libhector_gazebo_ros_imu.so/accelOffset, libhector_gazebo_ros_imu.so/rateOffset
    # conforms: libhector_gazebo_ros_imu.so/accelGaussianNoise
    # conforms: libhector_gazebo_ros_imu.so/rateGaussianNoise
    # conforms: libhector_gazebo_ros_imu.so/accelScaleError
    # conforms: libhector_gazebo_ros_imu.so/accelDrift
    # conforms: libhector_gazebo_ros_imu.so/rateDrift, libhector_gazebo_ros_gps.so/velocityOffset
    # conforms: libhector_gazebo_ros_gps.so/velocityGaussianNoise
    # conforms: libhector_gazebo_ros_gps.so/velocityDrift
    # conforms: libhector_gazebo_ros_magnetic.so/offset, libhector_gazebo_ros_magnetic.so/drift
    # conforms: libhector_gazebo_ros_magnetic.so/gaussianNoise
    # conforms: libhector_gazebo_ros_magnetic.so/scaleError, libhector_gazebo_ros_baro.so/offset
    # conforms: libhector_gazebo_ros_baro.so/drift, libhector_gazebo_ros_baro.so/gaussianNoise
    # conforms: libhector_gazebo_ros_baro.so/scaleError
    prefix, topic, read, true = ERRORS[name]

    def told(error: str, value: str, seconds: float = 0.2) -> np.ndarray:
        tag = prefix + error if prefix else error[0].lower() + error[1:]
        tags = f"<{tag}>{value}</{tag}><updateRate>0</updateRate><bodyName>mast</bodyName>"
        messages = take(bench, topic, hector(LIBRARIES.get(name, name), tags), seconds)
        bench.delete("bot")
        return np.array([read(message) for message in messages])

    true = np.array(true)
    three = " 0.25 0.75" if len(true) == 3 else ""
    offset = told("Offset", f"0.5{three}")[-1] - true
    assert offset == pytest.approx([0.5, 0.25, 0.75][:len(true)], abs=1e-3)
    assert told("GaussianNoise", "0.1", 0.5).std(axis=0) == pytest.approx(
        np.full(len(true), 0.1), rel=0.2)
    assert told("ScaleError", "1.5")[-1] == pytest.approx(1.5 * true, abs=1e-3)
    drifting = told("Drift", "0.1") - true
    assert np.abs(drifting[0]).min() > 1e-4  # it starts with one
    assert drifting.std(axis=0).max() < 0.02  # and keeps it for long
    assert len(np.unique(drifting[:, 0])) > 100


def test_scale_errors_of_what_moves(bench):
    # conforms: libhector_gazebo_ros_imu.so/rateScaleError
    # conforms: libhector_gazebo_ros_gps.so/velocityScaleError
    told = {}
    for kind, topic, tag in (("imu", "/imu", "rateScaleError"),
                             ("gps", "/fix_velocity", "velocityScaleError")):
        text = f"""<model name="bot"><link name="base"><gravity>false</gravity></link>
          <plugin name="p" filename="libhector_gazebo_ros_{kind}.so">
          <{tag}>0.5</{tag}><updateRate>100</updateRate></plugin></model>"""
        bench.spawn(text, Pose((0, 0, 9))).set_twist(Twist((3, 0, 0), (0, 0, 2)))
        messages = bench.listen(topic)
        bench.run(0.02)
        told[kind] = messages[-1]
        bench.delete("bot")
    assert told["imu"].angular_velocity.z == pytest.approx(1.0, abs=1e-3)
    assert told["gps"].vector.x == pytest.approx(1.5, abs=1e-3)


@pytest.mark.parametrize("tags, topic, read", [
    ("<accelDrift>0.1</accelDrift><accelDriftFrequency>50</accelDriftFrequency>", "/imu",
     lambda m: m.linear_acceleration.x),
    ("<rateDrift>0.1</rateDrift><rateDriftFrequency>50</rateDriftFrequency>", "/imu",
     lambda m: m.angular_velocity.x),
    ("<velocityDrift>0.1</velocityDrift><velocityDriftFrequency>50</velocityDriftFrequency>",
     "/fix_velocity", lambda m: m.vector.x),
    ("<drift>0.1</drift><driftFrequency>50</driftFrequency>", "/magnetic", lambda m: m.vector.y),
    ("<drift>0.1</drift><driftFrequency>50</driftFrequency>", "/pressure_height",
     lambda m: m.point.z)])
def test_a_quick_drift_wanders_with_its_deviation(bench, tags, topic, read):
    # conforms: libhector_gazebo_ros_imu.so/accelDriftFrequency
    # conforms: libhector_gazebo_ros_imu.so/rateDriftFrequency
    # conforms: libhector_gazebo_ros_gps.so/velocityDriftFrequency
    # conforms: libhector_gazebo_ros_magnetic.so/driftFrequency
    # conforms: libhector_gazebo_ros_baro.so/driftFrequency
    kinds = {"/imu": "imu", "/fix_velocity": "gps", "/magnetic": "magnetic",
             "/pressure_height": "baro"}
    text = hector(kinds[topic], tags + "<updateRate>0</updateRate>")
    told = np.array([read(message) for message in take(bench, topic, text, 2.0)])
    assert told.std() == pytest.approx(0.1, rel=0.4)
    assert np.diff(told).std() < 0.05


def test_a_drift_does_not_depend_on_who_looks(bench):
    # conforms: libhector_gazebo_ros_magnetic.so/drift
    told = []
    for listeners in (0, 1):
        bench.call("/gazebo/reset_simulation")
        bench.spawn(hector("magnetic", "<drift>1</drift><driftFrequency>9</driftFrequency>"))
        bench.listen("/magnetic", listeners)
        bench.run(0.1)
        fields = bench.listen("/magnetic")
        bench.run(0.1)
        told.append(xyz(fields[-1].vector))
        bench.delete("bot")
    assert told[0] == told[1]


@pytest.mark.parametrize("kind, namespace, topic, read", [
    ("imu", "/imu/accel", "/imu", lambda m: m.linear_acceleration.x),
    ("imu", "/imu/rate", "/imu", lambda m: m.angular_velocity.x),
    ("gps", "/fix/velocity", "/fix_velocity", lambda m: m.vector.x),
    ("gps", "/fix/position", "/fix", lambda m: m.altitude),
    ("magnetic", "/magnetic", "/magnetic", lambda m: m.vector.y),
    ("baro", "/altimeter", "/pressure_height", lambda m: m.point.z)])
def test_errors_can_be_reconfigured(bench, kind, namespace, topic, read):
    # conforms: TOPIC/set_parameters of hector's sensors
    messages = take(bench, topic, hector(kind, "<updateRate>100</updateRate>"))
    before = read(messages[-1])
    reconfigure(bench, namespace, {"offset": 0.5})
    bench.run(0.05)
    assert read(messages[-1]) - before == pytest.approx(0.5, abs=1e-6)
    bench.delete("bot")
    assert f"{namespace}/set_parameters" not in bench.graph.services


@pytest.mark.parametrize("tag", ["<accelDrift>x</accelDrift>",
                                 "<accelGaussianNoise>-1</accelGaussianNoise>"])
def test_an_error_tag_that_cannot_be_is_one_line(bench, caplog, tag):
    # conforms: libhector_gazebo_ros_imu.so/accelDrift
    bench.spawn(hector("imu", tag))
    assert f"is not loaded: {tag[:11]}" in caplog.text


def test_the_status_can_be_reconfigured(bench):
    # conforms: TOPIC/set_parameters of hector's sensors
    fixes = take(bench, "/fix", hector("gps", "<updateRate>100</updateRate>"))
    reconfigure(bench, "/fix/status", bools={"STATUS_GBAS_FIX": True, "SERVICE_GALILEO": False})
    bench.run(0.05)
    assert (fixes[-1].status.status, fixes[-1].status.service) == (2, 7)
    reconfigure(bench, "/fix/status", bools={"STATUS_FIX": False})
    bench.run(0.05)
    assert fixes[-1].status.status == NavSatStatus.STATUS_NO_FIX
