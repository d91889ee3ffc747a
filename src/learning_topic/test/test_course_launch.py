"""The course's launch files as roslaunch's own loader reads them: what their arguments reach."""

from pathlib import Path
from xml.etree import ElementTree

import pytest
from roslaunch.config import ROSLaunchConfig
from roslaunch.core import RLException
from roslaunch.xmlloader import XmlLoader

LAUNCH = Path(__file__).resolve().parents[1] / "launch"
FILES = ("0course.launch", "course_follow.launch")


def load(file, *arguments):
    config = ROSLaunchConfig()
    path = str(LAUNCH / file)
    XmlLoader().load(path, config, argv=[path, "gui:=false", *arguments], verbose=False)
    params = {name: param.value for name, param in config.params.items()}
    return {node.name: node for node in config.nodes}, params


def image_size(params):
    image = ElementTree.fromstring(params["/robot_description"]).find(".//camera/image")
    return image.findtext("width"), image.findtext("height")


@pytest.mark.parametrize("file", FILES)
def test_the_usual_course(file, monkeypatch):
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)
    nodes, params = load(file)
    assert image_size(params) == ("1920", "1080")
    assert not {"-u", "--pause"} & set(nodes["gazebo"].args.split())
    assert "real_time_factor" not in nodes["gazebo"].args
    assert "/gazebo/lockstep" not in params and "/gazebo/profile" not in params
    assert ("follower" in nodes) == (file == "course_follow.launch")


@pytest.mark.parametrize("file, arguments, seconds", [
    ("0course.launch", (), "0"), ("course_follow.launch", (), "0.3"),
    ("course_follow.launch", ("command_timeout:=0",), "0")])
def test_a_killed_follower_leaves_a_standing_robot(file, arguments, seconds):
    _, params = load(file, *arguments)
    robot = ElementTree.fromstring(params["/robot_description"])
    assert [tag.text for tag in robot.iter("commandTimeout")] == [seconds]


@pytest.mark.parametrize("file", FILES)
def test_arguments_reach_the_simulator(file):
    nodes, params = load(file, "paused:=true", "real_time_factor:=0", "lockstep:=/cmd_vel",
                         "lockstep_timeout:=5", "seed:=7", "profile:=true")
    words = nodes["gazebo"].args.split()
    assert "-u" in words and "--real_time_factor=0" in words and "--seed=7" in words
    assert params["/gazebo/lockstep"] == "/cmd_vel" and params["/gazebo/profile"] is True
    assert params["/gazebo/lockstep_timeout"] == 5


@pytest.mark.parametrize("model", ["waffle", "waffle_pi"])
@pytest.mark.parametrize("file", FILES)
def test_the_cameras_size(file, model):
    _, params = load(file, f"model:={model}", "camera_width:=320", "camera_height:=200")
    assert image_size(params) == ("320", "200")


@pytest.mark.parametrize("file", FILES)
def test_a_burger_takes_them_too(file):
    _, params = load(file, "model:=burger", "camera_width:=320", "camera_height:=200")
    assert "turtlebot3_burger" in params["/robot_description"]


@pytest.mark.parametrize("size", ["0", "wide"])
@pytest.mark.parametrize("file", FILES)
def test_a_wrong_camera_size_is_an_error(file, size, capfd):
    with pytest.raises(RLException):
        load(file, f"camera_width:={size}")
    said = [line for line in capfd.readouterr().err.splitlines() if "camera_width is" in line]
    assert len(said) == 1 and "a whole number of pixels, 1 or more" in said[0]
