"""The car as data: links, joints, transmissions, sensors, gains, meshes."""

import math
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import yaml
from racecar_in_world import AXLES, HINGES, TRACK, WHEEL_RADIUS, WHEELBASE, Car, at

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro.files import expand
from bullet_sim.sensors.laser import Laser

PACKAGE = Path(__file__).resolve().parent.parent
sys.path.append(str(PACKAGE.parents[1] / "tools/makers"))
import racecar_meshes  # noqa: E402

URDF = PACKAGE / "urdf" / "racecar.urdf.xacro"
WHEELS = {"velocity": "JointVelocityController", "position": "JointPositionController"}
CONTROLLERS = {  # name: type, joint, p, d
    "left_rear_wheel_velocity_controller": ("velocity", "left_rear_axle", 1.0, 0.0),
    "right_rear_wheel_velocity_controller": ("velocity", "right_rear_axle", 1.0, 0.0),
    "left_front_wheel_velocity_controller": ("velocity", "left_front_axle", 0.5, 0.0),
    "right_front_wheel_velocity_controller": ("velocity", "right_front_axle", 0.5, 0.0),
    "left_steering_hinge_position_controller": ("position", "left_steering_joint", 10.0, 0.5),
    "right_steering_hinge_position_controller": ("position", "right_steering_joint", 10.0, 0.5),
}


@pytest.fixture(scope="module")
def robot():
    return ElementTree.fromstring(expand(URDF))


@pytest.fixture(scope="module")
def car():
    racecar = Car("racetrack")
    yield racecar
    racecar.world.close()


def read(name):
    return yaml.safe_load((PACKAGE / "config" / name).read_text(encoding="utf-8"))["racecar"]


def sensor(car, kind):
    return next((link, each) for link in car.model.links.values()
                for each in link.description.sensors if each.type == kind)


def test_links(robot):
    names = {link.get("name") for link in robot.findall("link")}
    corners = [f"{side}_{end}" for side in ("left", "right") for end in ("front", "rear")]
    assert names == {"base_link", "chassis", "camera_link", "camera_optical_link", "laser_link",
                     "imu_link", "left_steering_hinge", "right_steering_hinge",
                     *(f"{corner}_wheel" for corner in corners)}


def test_moving_joints(robot):
    moving = {joint.get("name"): (joint.get("type"), joint.find("axis").get("xyz"))
              for joint in robot.findall("joint") if joint.get("type") != "fixed"}
    assert moving == {**dict.fromkeys(AXLES, ("continuous", "0 1 0")),
                      **dict.fromkeys(HINGES, ("revolute", "0 0 1"))}
    for hinge in HINGES:
        limit = robot.find(f"joint[@name='{hinge}']/limit")
        assert (float(limit.get("lower")), float(limit.get("upper"))) == (-0.6, 0.6)


def test_every_moving_joint_can_be_driven(robot):
    interfaces = {each.find("joint").get("name"): each.findtext("joint/hardwareInterface")
                  for each in robot.findall("transmission")}
    effort = "hardware_interface/EffortJointInterface"
    assert interfaces == dict.fromkeys((*AXLES, *HINGES), effort)
    assert {each.findtext("type") for each in robot.findall("transmission")} == {
        "transmission_interface/SimpleTransmission"}


def test_wheels_stand_where_they_should(car):
    x, y, _ = car.model.pose.position
    for name, link in car.model.links.items():
        if name.endswith("_wheel"):
            expected = (WHEELBASE if "front" in name else 0.0,
                        TRACK / 2 if "left" in name else -TRACK / 2, WHEEL_RADIUS)
            found = np.subtract(link.pose.position, (x, y, 0.0))
            assert found == pytest.approx(expected, abs=1e-4)


def test_weight(car):
    """4.5 kg, its centre in the middle between the axles and low."""
    parts = [(link.description.inertial.mass, (link.description.pose
              * link.description.inertial.pose).position) for link in car.model.links.values()]
    masses = np.array([mass for mass, _ in parts])
    centre = masses @ np.array([place for _, place in parts]) / masses.sum()
    assert masses.sum() == pytest.approx(4.5, abs=0.05)
    assert centre == pytest.approx((WHEELBASE / 2, 0.0, 0.065), abs=0.01)


def test_gains_are_the_tutorials():
    given = read("controller_racecar.yaml")
    states = given.pop("joint_state_controller")
    assert states == {"type": "joint_state_controller/JointStateController", "publish_rate": 50}
    expected = {}
    for name, (kind, joint, p, d) in CONTROLLERS.items():
        pid = {"p": p, "i": 0.0, "d": d} | ({"i_clamp": 0.0} if kind == "velocity" else {})
        expected[name] = {"type": f"effort_controllers/{WHEELS[kind]}", "joint": joint, "pid": pid}
    assert given == expected


def test_every_command_expires():
    assert read("command_timeout.yaml") == {
        name: {"command_timeout": 0.2} for name in CONTROLLERS}


def test_plugins(robot):
    plugins = {each.get("filename"): each for each in robot.iter("plugin")}
    assert set(plugins) == {"libgazebo_ros_control.so", "libgazebo_ros_camera.so",
                            "libgazebo_ros_laser.so", "libgazebo_ros_imu.so",
                            "libgazebo_ros_p3d.so"}
    assert plugins["libgazebo_ros_control.so"].findtext("robotNamespace") == "/racecar"
    truth = plugins["libgazebo_ros_p3d.so"]
    assert [truth.findtext(tag) for tag in ("topicName", "frameName", "bodyName")] == [
        "ground_truth", "world", "base_link"]
    assert float(truth.findtext("updateRate")) == 50
    assert float(truth.findtext("gaussianNoise")) == 0


def test_the_camera(car):
    camera = sensor(car, "camera")[1]
    (pinhole,) = camera.cameras
    assert (pinhole.width, pinhole.height, camera.update_rate) == (1280, 720, 30)


@pytest.mark.parametrize("size", ["0", "wide", "-3"])
def test_a_wrong_camera_size_is_an_error(size):
    with pytest.raises(FormatError, match="camera_width is"):
        expand(URDF, {"camera_width": size})


def test_camera_noise_is_as_asked(robot):
    assert robot.find(".//camera/noise") is None
    noise = ElementTree.fromstring(expand(URDF, {"camera_noise": "0.02"})).find(".//camera/noise")
    assert [each.text for each in noise] == ["gaussian", "0.0", "0.02"]


@pytest.mark.parametrize("noise", ["-0.01", "much", "nan", "2"])
def test_a_wrong_camera_noise_is_an_error(noise):
    with pytest.raises(FormatError, match="camera_noise is"):
        expand(URDF, {"camera_noise": noise})


def test_the_optical_frame_looks_where_the_camera_looks(car):
    """z ahead and 14 degrees down, x to the right."""
    lumped = car.model.description.lumped
    matrix = lumped["camera_optical_link"][1].matrix()[:3, :3]
    assert matrix[:, 2] == pytest.approx((math.cos(0.25), 0.0, -math.sin(0.25)), abs=1e-6)
    assert matrix[:, 0] == pytest.approx((0.0, -1.0, 0.0), abs=1e-6)


def test_the_laser_does_not_see_the_car(car):
    link, description = sensor(car, "ray")
    car.model.set_pose(at(0.0, 0.8))  # in the middle of the lawn
    reading = Laser(car.world, link, description).sample()
    assert len(reading.ranges) == 541
    assert math.degrees(reading.angle_min) == pytest.approx(-135)
    assert math.degrees(reading.angle_max) == pytest.approx(135)
    assert 2.5 < reading.ranges.min() < 4.0
    assert np.isfinite(reading.ranges).all()  # the wall is as high as the beams, all round


def test_urdfdom_reads_it(tmp_path):
    urdf = tmp_path / "racecar.urdf"
    urdf.write_text(expand(URDF))
    subprocess.run(["check_urdf", str(urdf)], check=True, capture_output=True)


def test_solids_are_closed_and_face_outwards():
    """Each edge belongs to two faces, once in either direction; and the volume is positive."""
    for parts in (racecar_meshes.chassis(), racecar_meshes.wheel()):
        for solid in parts.values():
            edges = [(a, b) for face in solid for a, b in zip(face, [*face[1:], face[0]])]
            assert sorted(edges) == sorted((b, a) for a, b in edges)
            triangles = np.array([(face[0], a, b) for face in solid
                                  for a, b in pairwise(face[1:])])
            corners = np.moveaxis(triangles, 1, 0)
            assert np.einsum("ij,ij->", corners[0], np.cross(corners[1], corners[2])) > 0


def test_the_car_is_quick_to_draw():
    faces = sum(mesh.read_text().count("\nf ") for mesh in (PACKAGE / "meshes").glob("*.obj"))
    assert faces < 1500
