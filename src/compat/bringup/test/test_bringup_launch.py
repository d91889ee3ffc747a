"""The alias starts what racecar.launch starts, and hands every argument on."""

from pathlib import Path

import rospkg
from roslaunch.config import ROSLaunchConfig
from roslaunch.xmlloader import XmlLoader

ALIAS = Path(__file__).resolve().parents[1] / "launch" / "racecar_gazebo.launch"
RACECAR = Path(rospkg.RosPack().get_path("racecar_description")) / "launch" / "racecar.launch"
ARGUMENTS = ("gui:=false", "x_pos:=1.5", "y_pos:=-2.5", "z_pos:=0.1", "yaw:=0.7", "paused:=true",
             "real_time_factor:=0", "lockstep:=/motor_output", "lockstep_timeout:=5", "seed:=7",
             "pub_clock_frequency:=30", "profile:=true", "camera_width:=320",
             "camera_height:=200", "world_name:=worlds/empty.world", "headless:=true")


def load(path, arguments):
    config = ROSLaunchConfig()
    XmlLoader().load(str(path), config, argv=[str(path), *arguments], verbose=False)
    nodes = sorted((node.name, node.package, node.type, node.args) for node in config.nodes)
    return nodes, {name: param.value for name, param in config.params.items()}


def test_it_is_the_same():
    assert load(ALIAS, ["gui:=false"]) == load(RACECAR, ["gui:=false"])
    assert load(ALIAS, ARGUMENTS) == load(RACECAR, ARGUMENTS)
    assert load(ALIAS, ARGUMENTS) != load(ALIAS, ["gui:=false"])


def test_with_rviz_it_is_the_same_and_rviz():
    nodes, params = load(ALIAS, ARGUMENTS)
    with_rviz, params_with_rviz = load(ALIAS.with_name("racecar_gazebo_rviz.launch"), ARGUMENTS)
    (rviz,) = set(with_rviz) - set(nodes)
    assert len(with_rviz) == len(nodes) + 1 and params_with_rviz == params
    assert rviz[:3] == ("rviz", "rviz", "rviz") and rviz[3].endswith("racecar.rviz")
