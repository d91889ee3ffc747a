"""empty_world.launch as roslaunch's own loader reads it: upstream's 17 arguments and ours."""

from pathlib import Path
from xml.etree import ElementTree

import pytest
from roslaunch.config import ROSLaunchConfig
from roslaunch.core import RLException
from roslaunch.xmlloader import XmlLoader, XmlParseException

LAUNCH = Path(__file__).resolve().parents[1] / "launch/empty_world.launch"
DEFAULTS = {
    "paused": "false", "use_sim_time": "true", "extra_gazebo_args": "", "gui": "true",
    "recording": "false", "headless": "false", "debug": "false", "physics": "ode",
    "verbose": "false", "output": "screen", "world_name": "worlds/empty.world",
    "respawn_gazebo": "false", "use_clock_frequency": "false", "pub_clock_frequency": "100",
    "enable_ros_network": "true", "server_required": "false", "gui_required": "false",
}
OUR_OWN = {"real_time_factor": "", "lockstep": "", "lockstep_timeout": "1.0", "seed": "",
           "profile": "false", "viewer": "false"}


def load(*arguments, file=LAUNCH):
    config = ROSLaunchConfig()
    XmlLoader().load(str(file), config, argv=[str(file), *arguments], verbose=False)
    nodes = {node.name: node for node in config.nodes}
    params = {name: param.value for name, param in config.params.items()}
    return nodes, params


def command(*arguments):
    return load(*arguments)[0]["gazebo"].args.split()


def test_the_arguments_and_their_defaults():
    # conforms: empty_world.launch
    root = ElementTree.parse(LAUNCH).getroot()
    args = root.findall("arg")
    defaults = {a.get("name"): a.get("default") for a in args if "default" in a.attrib}
    assert defaults == DEFAULTS | OUR_OWN
    internal = {a.get("name") for a in args if "value" in a.attrib}
    assert internal == {*(f"command_arg{number}" for number in range(1, 6)), "script_type"}


def test_plain_start():
    nodes, params = load()
    assert params == {"/use_sim_time": True, "/gazebo/enable_ros_network": True}
    server, client = nodes["gazebo"], nodes["gazebo_gui"]
    assert (server.package, server.type) == ("gazebo_ros", "gzserver")
    assert (client.package, client.type, client.args.strip()) == ("gazebo_ros", "gzclient", "")
    assert server.args.split() == ["-e", "ode", "worlds/empty.world"]
    for node in (server, client):
        assert (node.respawn, node.required, node.output) == (False, False, "screen")


@pytest.mark.parametrize(("arguments", "words"), [
    (["paused:=true"], ["-u", "-e", "ode", "worlds/empty.world"]),
    (["recording:=true"], ["-r", "-e", "ode", "worlds/empty.world"]),
    (["verbose:=true"], ["--verbose", "-e", "ode", "worlds/empty.world"]),
    (["physics:=bullet", "world_name:=/a.world"], ["-e", "bullet", "/a.world"]),
    (["real_time_factor:=0"], ["--real_time_factor=0", "-e", "ode", "worlds/empty.world"]),
    (["seed:=7"], ["--seed=7", "-e", "ode", "worlds/empty.world"]),
    (["extra_gazebo_args:=--seed 3"], ["-e", "ode", "--seed", "3", "worlds/empty.world"]),
    (["paused:=true", "recording:=true", "verbose:=true", "headless:=true"],
     ["-u", "-r", "--verbose", "-e", "ode", "worlds/empty.world"]),
])
def test_the_servers_command_line(arguments, words):
    # conforms: empty_world.launch/paused, empty_world.launch/verbose, empty_world.launch/physics
    # conforms: empty_world.launch/world_name, empty_world.launch/extra_gazebo_args
    # conforms: empty_world.launch/real_time_factor, empty_world.launch/seed
    assert command(*arguments) == words


def test_debug_respawn_required_output():
    # conforms: empty_world.launch/debug, empty_world.launch/respawn_gazebo
    # conforms: empty_world.launch/output, empty_world.launch/server_required
    # conforms: empty_world.launch/gui_required, empty_world.launch/verbose
    nodes, _ = load("debug:=true", "respawn_gazebo:=true", "output:=log")
    assert nodes["gazebo"].type == "debug" and nodes["gazebo"].respawn
    assert not nodes["gazebo_gui"].respawn
    assert {node.output for node in nodes.values()} == {"log"}
    nodes, _ = load("server_required:=true")
    assert nodes["gazebo"].required and not nodes["gazebo_gui"].required
    nodes, _ = load("gui_required:=true", "verbose:=true")
    assert nodes["gazebo_gui"].required and nodes["gazebo_gui"].args.split() == ["--verbose"]


def test_without_gui_only_the_client_is_missing():
    # conforms: empty_world.launch/gui
    assert list(load("gui:=false")[0]) == ["gazebo"]


def test_the_page_in_the_browser_comes_only_when_asked_for():
    # conforms: empty_world.launch/viewer
    assert "sim_viewer" not in load()[0]
    assert load("viewer:=true")[0]["sim_viewer"].package == "sim_viewer"


def test_parameters():
    # conforms: empty_world.launch/use_sim_time, empty_world.launch/enable_ros_network
    # conforms: empty_world.launch/use_clock_frequency, empty_world.launch/pub_clock_frequency
    _, params = load("use_sim_time:=false", "enable_ros_network:=false",
                     "use_clock_frequency:=true", "pub_clock_frequency:=50")
    assert params == {"/use_sim_time": False, "/gazebo/enable_ros_network": False,
                      "/gazebo/pub_clock_frequency": 50}


def test_parameters_of_our_own():
    # conforms: empty_world.launch/lockstep, empty_world.launch/lockstep_timeout
    # conforms: empty_world.launch/profile
    _, params = load("lockstep:=/cmd_vel", "lockstep_timeout:=2.5", "profile:=true")
    ours = {name: value for name, value in params.items()
            if name not in ("/use_sim_time", "/gazebo/enable_ros_network")}
    assert ours == {"/gazebo/lockstep": "/cmd_vel", "/gazebo/lockstep_timeout": 2.5,
                    "/gazebo/profile": True}
    assert load("lockstep:=/cmd_vel")[1]["/gazebo/lockstep_timeout"] == 1.0


def test_in_a_group_node_and_parameters_share_the_namespace(tmp_path):
    outer = tmp_path / "outer.launch"
    outer.write_text(f'<launch><group ns="x"><include file="{LAUNCH}"/></group></launch>')
    nodes, params = load(file=outer)
    assert nodes["gazebo"].namespace == "/x/"
    assert params == {"/use_sim_time": True, "/x/gazebo/enable_ros_network": True}


def test_an_include_may_pass_all_17_and_no_other(tmp_path):
    def including(names):
        words = "".join(f'<arg name="{name}" value="{DEFAULTS.get(name, "1")}"/>' for name in names)
        outer = tmp_path / "outer.launch"
        outer.write_text(f'<launch><include file="{LAUNCH}">{words}</include></launch>')
        return load(file=outer)

    assert set(including(DEFAULTS)[0]) == {"gazebo", "gazebo_gui"}
    with pytest.raises((RLException, XmlParseException), match="headles"):
        including(["headles"])
