"""The racetrack: its line, its picture, its world, and the launch files that use them."""

import math
import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import cv2
import numpy as np
import pytest
from racecar_description.track.closed_line import load_track
from racecar_description.track.track_file import load_track_file
from racecar_in_world import MIDDLE, PACKAGE, RESOURCES
from roslaunch.config import ROSLaunchConfig
from roslaunch.core import RLException
from roslaunch.xmlloader import XmlLoader

from bullet_sim.description import Box, Plane
from bullet_sim.formats.loading import load_world

TRACK = PACKAGE / "tracks" / "racetrack.yaml"
FIELD = (12.0, 8.0)  # m, inside the walls
COLOURS = {"lawn": (60, 90), "road": (45, 65), "white": (225, 245), "yellow": (240, 255)}  # red
LAUNCHES = ("racecar.launch", "car_control.launch")


def test_the_spawner_of_a_second_car_is_told_its_simulator():
    def of(*words):
        return subprocess.run(
            ["roslaunch", "racecar_description", "racecar.launch", "--args", "/spawn_urdf", *words],
            text=True, capture_output=True, timeout=60, check=True).stdout

    assert "-gazebo_namespace /gazebo " in of()
    assert "-gazebo_namespace /two/gazebo " in of("gazebo_namespace:=/two/gazebo")


@pytest.fixture(scope="module")
def line():
    return load_track(TRACK)


@pytest.fixture(scope="module")
def world():
    return load_world(PACKAGE / "worlds" / "racetrack.world", RESOURCES)


def launched(file, *arguments):
    config, path = ROSLaunchConfig(), str(PACKAGE / "launch" / file)
    XmlLoader().load(path, config, argv=[path, "gui:=false", *arguments], verbose=False)
    params = {name: param.value for name, param in config.params.items()}
    return {node.name: node for node in config.nodes}, params


def test_the_line(line):
    """Closed, 30 to 40 m round, no bend tighter than 1.2 m, left and right ones among them."""
    bends = [piece.curvature for piece in line.pieces if piece.curvature]
    assert 30 < line.length < 40
    assert max(map(abs, bends)) <= 1 / 1.2 + 1e-9
    assert min(bends) < 0 < max(bends)
    turned = sum(piece.curvature * piece.length for piece in line.pieces)
    assert turned == pytest.approx(2 * math.pi)


def test_the_road_keeps_clear_of_itself_and_the_walls(line):
    points = np.array(line.points(0.05))
    assert (np.abs(points - MIDDLE) < np.array(FIELD) / 2 - 0.7).all()
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    steps = np.abs(np.subtract.outer(np.arange(len(points)), np.arange(len(points))))
    along = np.minimum(steps, len(points) - steps) * line.length / len(points)
    assert apart[along > 2.5].min() > 1.5


def test_the_picture_shows_the_line(line):
    """Centre line, asphalt, edge line, lawn: each where the YAML says, all along the track."""
    picture = cv2.imread(str(PACKAGE / "models/racetrack/materials/textures/racetrack.png"))
    height, width = picture.shape[:2]
    assert (width / FIELD[0], height / FIELD[1]) == (256, 256)
    edge = load_track_file(TRACK).lane_width
    for left, what in ((0.0, "yellow"), (0.2, "road"), (-0.2, "road"), (edge, "white"),
                       (-edge, "white"), (0.55, "lawn"), (-0.55, "lawn")):
        low, high = COLOURS[what]
        x, y = (np.array(line.offset(left).points(0.1)) - MIDDLE).T
        red = picture[(height / 2 - y * 256).astype(int), (width / 2 + x * 256).astype(int), 2]
        assert low <= red.min() and red.max() <= high, what


def test_the_world(world, line):
    models = {model.name: model for model in world.models}
    assert set(models) == {"ground_plane", "racetrack", "smartcar_plane", "north_wall",
                           "south_wall", "east_wall", "west_wall"}
    (road,) = models["racetrack"].links[0].visuals
    assert isinstance(road.geometry, Plane) and road.geometry.size == FIELD
    assert Path(road.material.texture).name == "racetrack.png"
    plate = models["smartcar_plane"]
    assert plate.pose.position[:2] == pytest.approx(line.pose(0.0)[:2], abs=1e-6)
    assert not plate.links[0].collisions
    assert world.physics.max_step_size == 0.001


def test_the_walls_close(world):
    """Their inner faces are the field's sides, and no gap is at the corners."""
    for model in world.models:
        if model.name.endswith("_wall"):
            (shape,) = model.links[0].collisions
            assert isinstance(shape.geometry, Box)
            centre = np.array(model.pose.position) - (*MIDDLE, 0.0)
            low, high = (centre + side * np.array(shape.geometry.size) / 2 for side in (-1, 1))
            axis = 0 if model.name in ("east_wall", "west_wall") else 1
            assert np.abs((low, high))[:, axis].min() == pytest.approx(FIELD[axis] / 2)
            assert min(-low[1 - axis], high[1 - axis]) >= FIELD[1 - axis] / 2
            assert (low[2], high[2]) == pytest.approx((0.0, 0.25))


@pytest.mark.parametrize("file", LAUNCHES)
def test_the_car_starts_on_the_line(file, line):
    nodes, params = launched(file)
    place = [float(re.search(rf"-{letter} (\S+)", nodes["spawn_urdf"].args)[1])
             for letter in ("x", "y", "Y")]
    assert place == pytest.approx(line.pose(0.0), abs=1e-6)
    states = ["joint_states", "/racecar/joint_states"]
    assert states in nodes["robot_state_publisher"].remap_args
    assert params["/robot_state_publisher/publish_frequency"] == 20
    image = ElementTree.fromstring(params["/robot_description"]).find(".//camera/image")
    assert (image.findtext("width"), image.findtext("height")) == ("1280", "720")
    assert nodes["gazebo"].args.split()[-1].endswith("/worlds/racetrack.world")


@pytest.mark.parametrize("file", LAUNCHES)
def test_arguments_reach_the_simulator(file):
    nodes, params = launched(
        file, "paused:=true", "real_time_factor:=0", "lockstep:=/motor_output", "seed:=7",
        "lockstep_timeout:=5", "profile:=true", "pub_clock_frequency:=30", "camera_width:=320",
        "camera_height:=200", "world_name:=worlds/empty.world", "x_pos:=1", "yaw:=0.5")
    words = nodes["gazebo"].args.split()
    assert {"-u", "--real_time_factor=0", "--seed=7", "worlds/empty.world"} <= set(words)
    assert params["/gazebo/lockstep"] == "/motor_output" and params["/gazebo/profile"] is True
    assert params["/gazebo/lockstep_timeout"] == 5
    assert params["/gazebo/pub_clock_frequency"] == 30
    image = ElementTree.fromstring(params["/robot_description"]).find(".//camera/image")
    assert (image.findtext("width"), image.findtext("height")) == ("320", "200")
    assert "-x 1 " in nodes["spawn_urdf"].args and "-Y 0.5 " in nodes["spawn_urdf"].args


@pytest.mark.parametrize("file", LAUNCHES)
def test_a_wrong_camera_size_is_an_error(file, capfd):
    with pytest.raises(RLException):
        launched(file, "camera_width:=wide")
    said = [line for line in capfd.readouterr().err.splitlines() if "camera_width is" in line]
    assert len(said) == 1 and "a whole number of pixels, 1 or more" in said[0]


def test_car_control_starts_seven_controllers():
    nodes, params = launched("car_control.launch")
    spawner = nodes["controller_manager"]
    assert (spawner.package, spawner.type, spawner.namespace) == (
        "controller_manager", "spawner", "/racecar/")
    assert len(spawner.args.split()) == 7
    for name in spawner.args.split():
        assert f"/racecar/{name}/type" in params
        assert f"/racecar/{name}/command_timeout" not in params
    assert params["/motor_control/ackermann"] is False
    drivers = {(node.package, node.type) for node in nodes.values()
               if node.package == "car_control"}
    assert drivers == {("car_control", "motor_control.py"), ("car_control", "keyboard_control.py")}


@pytest.mark.parametrize("file", ["race.launch", "mapping.launch", "navigation.launch"])
def test_our_own_launch_files_steer_by_ackermann_and_forget_old_commands(file):
    _, params = launched(file)
    assert params["/motor_control/ackermann"] is True
    timeouts = [value for name, value in params.items() if name.endswith("/command_timeout")]
    assert timeouts == [0.2] * 6


def test_the_keyboard_can_be_left_out():
    nodes, _ = launched("car_control.launch", "keyboard:=false")
    assert "motor_control" in nodes and "key_control" not in nodes


def test_rviz_shows_the_car():
    nodes, params = launched("racecar_rviz.launch")
    assert nodes["rviz"].args.endswith("/rviz/racecar.rviz") and "/robot_description" in params
    nodes, params = launched("racecar_rviz.launch", "simulated:=true")
    assert set(nodes) == {"rviz"} and "/robot_description" not in params
    shown = (PACKAGE / "rviz" / "racecar.rviz").read_text()
    assert "Fixed Frame: base_link" in shown
    for topic in ("/scan", "/camera/image_raw"):
        assert topic in shown
