"""The launch files beside empty_world.launch: upstream's arguments, and worlds that are there."""

from pathlib import Path
from xml.etree import ElementTree

import pytest
import rospkg
from roslaunch.config import ROSLaunchConfig
from roslaunch.xmlloader import XmlLoader

from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources

LAUNCH = Path(__file__).resolve().parents[1] / "launch"
RESOURCES = Resources.from_environment({})
TEST_WORLDS = Path(rospkg.RosPack().get_path("gazebo_plugins")) / "test/test_worlds"
RANGE = {
    "paused": "false", "use_sim_time": "true", "extra_gazebo_args": "", "gui": "true",
    "debug": "false", "physics": "ode", "verbose": "true", "output": "screen",
    "world": "gazebo_ros_range"}
ELEVATOR = {
    "paused": "false", "use_sim_time": "true", "extra_gazebo_args": "", "gui": "true",
    "recording": "false", "headless": "false", "debug": "false", "physics": "ode",
    "verbose": "true", "output": "screen", "world_name": "worlds/elevator_ros.world"}


def load(name, *arguments):
    config = ROSLaunchConfig()
    file = str(LAUNCH / name)
    XmlLoader().load(file, config, argv=[file, *arguments], verbose=False)
    return ({node.name: node for node in config.nodes},
            {name: param.value for name, param in config.params.items()})


def defaults(name):
    args = ElementTree.parse(LAUNCH / name).getroot().findall("arg")
    return {arg.get("name"): arg.get("default") for arg in args if "default" in arg.attrib}


def world_of(nodes):
    return nodes["gazebo"].args.split()[-1]


@pytest.mark.parametrize("name", ["mud", "rubble", "shapes", "willowgarage"])
def test_a_launch_file_of_one_world(name):
    # conforms: mud_world.launch, rubble_world.launch, shapes_world.launch
    # conforms: willowgarage_world.launch
    file = f"{name}_world.launch"
    nodes, params = load(file, "gui:=false")  # has no effect, as upstream
    assert defaults(file) == {} and set(nodes) == {"gazebo", "gazebo_gui"}
    assert nodes["gazebo"].args.split() == ["-e", "ode", f"worlds/{name}.world"]
    assert params == {"/use_sim_time": True, "/gazebo/enable_ros_network": True}
    world = load_world(RESOURCES.find_world(world_of(nodes)), RESOURCES)
    assert {"ground_plane"} < {model.name for model in world.models}


def test_range_world_takes_upstreams_arguments():
    # conforms: range_world.launch, range_world.launch/paused, range_world.launch/use_sim_time
    # conforms: range_world.launch/extra_gazebo_args, range_world.launch/gui
    # conforms: range_world.launch/debug, range_world.launch/physics, range_world.launch/verbose
    # conforms: range_world.launch/output, range_world.launch/world
    assert defaults("range_world.launch") == RANGE
    nodes, _ = load("range_world.launch")
    assert nodes["gazebo"].args.split() == [
        "--verbose", "-e", "ode", f"{TEST_WORLDS}/gazebo_ros_range.world"]
    nodes, params = load(
        "range_world.launch", "paused:=true", "use_sim_time:=false", "extra_gazebo_args:=--iters 5",
        "gui:=false", "debug:=true", "physics:=bullet", "verbose:=false", "output:=log",
        "world:=gazebo_ros_laser")
    server = nodes.pop("gazebo")
    assert not nodes and (server.type, server.output) == ("debug", "log")
    assert server.args.split() == ["-u", "-e", "bullet", "--iters", "5",
                                   f"{TEST_WORLDS}/gazebo_ros_laser.world"]
    assert params["/use_sim_time"] is False


def test_elevator_world_takes_upstreams_arguments():
    # conforms: elevator_world.launch, elevator_world.launch/paused
    # conforms: elevator_world.launch/use_sim_time, elevator_world.launch/extra_gazebo_args
    # conforms: elevator_world.launch/gui, elevator_world.launch/debug
    # conforms: elevator_world.launch/physics, elevator_world.launch/verbose
    # conforms: elevator_world.launch/output, elevator_world.launch/world_name
    assert defaults("elevator_world.launch") == ELEVATOR
    nodes, params = load("elevator_world.launch")
    assert nodes["gazebo"].args.split() == [
        "--verbose", "-e", "ode", "worlds/elevator_ros.world"]
    assert not nodes["gazebo_gui"].args.strip() and params == {"/use_sim_time": True}
    nodes, params = load(
        "elevator_world.launch", "paused:=true", "use_sim_time:=false", "headless:=true",
        "recording:=true", "extra_gazebo_args:=--iters 5", "gui:=false", "debug:=true",
        "physics:=dart", "verbose:=false", "output:=log", "world_name:=/a.world")
    server = nodes.pop("gazebo")
    assert not nodes and (server.type, server.output) == ("debug", "log") and params == {}
    assert server.args.split() == ["-u", "-r", "-e", "dart", "--iters", "5", "/a.world"]


def test_the_elevator_is_the_same_in_both_places():
    ours = RESOURCES.find_world("worlds/elevator_ros.world").read_text(encoding="utf-8")
    assert (TEST_WORLDS / "elevator.world").read_text(encoding="utf-8") == ours
