"""The two AutoRace burgers against upstream's published numbers."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from bullet_sim.formats.xacro.files import expand

URDF = Path(__file__).resolve().parent.parent / "urdf"
JOINTS = {  # robot: joint, parent, child, xyz (m), rpy (rad)
    "": [("camera_joint", "base_link", "camera_link", "0.040 -0.011 0.130", "0 0.174 0"),
         ("camera_rgb_joint", "camera_link", "camera_rgb_frame", "0.003 0.011 0.009", "0 0 0"),
         ("camera_rgb_optical_joint", "camera_rgb_frame", "camera_rgb_optical_frame", "0 0 0",
          "-1.57 0 -1.57")],
    "_2020": [("camera_joint", "base_link", "camera_dummy_link", "0.040 0 0.110", "0 0 0"),
              ("camera_frame_joint", "camera_dummy_link", "camera_frame", "0.003 0 0.009",
               "0 0 0"),
              ("camera_optical_joint", "camera_frame", "camera_optical_frame", "0 0 0",
               "-1.5707 0 -1.57")],
}
MASSES = {"": (0.82573504, 0.02849894, 0.005), "_2020": (8.2573504, 2.849894, 0.000001)}  # kg
CAMERAS = {  # link, sensor's type and name, fov, near, frame
    "": ("camera_rgb_frame", "camera", "Pi Camera", 1.085595, 0.03, "camera_rgb_optical_frame"),
    "_2020": ("camera_frame", "wideanglecamera", "camera", 3.183, 0.1, "camera_link"),
}
LENS = {"type": "custom", "custom_function/c1": "1.05", "custom_function/c2": "4",
        "custom_function/f": "1.0", "custom_function/fun": "tan", "scale_to_hfov": "true",
        "cutoff_angle": "3.1415", "env_texture_size": "512"}


@pytest.fixture(scope="module", params=JOINTS)
def burger(request):
    text = expand(URDF / f"turtlebot3_burger_for_autorace{request.param}.urdf.xacro")
    return request.param, ElementTree.fromstring(text)


def test_camera_joints(burger):
    year, robot = burger
    for name, parent, child, xyz, rpy in JOINTS[year]:
        joint = robot.find(f"joint[@name='{name}']")
        ends = joint.find("parent").get("link"), joint.find("child").get("link")
        assert ends == (parent, child)
        assert joint.find("origin").get("xyz") == xyz
        assert joint.find("origin").get("rpy") == rpy


def test_masses(burger):
    year, robot = burger
    found = [float(robot.find(f"link[@name='{name}']/inertial/mass").get("value"))
             for name in ("base_link", "wheel_left_link", "caster_back_link")]
    assert tuple(found) == MASSES[year]


def test_camera(burger):
    year, robot = burger
    link, kind, name, fov, near, frame = CAMERAS[year]
    sensor = robot.find(f"gazebo[@reference='{link}']/sensor[@type='{kind}'][@name='{name}']")
    image = sensor.find("camera/image")
    assert (image.findtext("width"), image.findtext("height")) == ("320", "240")
    assert float(sensor.findtext("camera/horizontal_fov")) == fov
    assert float(sensor.findtext("camera/clip/near")) == near
    plugin = sensor.find("plugin[@filename='libgazebo_ros_camera.so']")
    assert plugin.findtext("frameName") == frame
    topics = [plugin.findtext(tag) for tag in
              ("cameraName", "imageTopicName", "cameraInfoTopicName", "updateRate")]
    assert topics == ["camera", "image", "camera_info", "30.0"]
    lens = sensor.find("camera/lens")
    assert (lens is not None) == (year == "_2020")
    assert lens is None or {tag: lens.findtext(tag) for tag in LENS} == LENS


def test_the_imu_plugin_names_no_frame(burger):
    _, robot = burger
    (imu,) = (each for each in robot.iter("plugin")
              if each.get("filename") == "libgazebo_ros_imu.so")
    assert imu.find("frameName") is None and imu.findtext("bodyName") == "imu_link"
