"""Launch and parameter files of upstream's packages that others include: ours have them too."""

from pathlib import Path

import pytest
import roslaunch.config
import yaml
from rospkg import RosPack

FILES = {
    "joint_state_controller": ["joint_state_controller.yaml", "joint_state_controller.launch",
                               "launch/joint_state_controller.launch"],
    "amcl": ["examples/amcl_diff.launch", "examples/amcl_omni.launch"],
    "costmap_2d": ["launch/example.launch", "launch/example_params.yaml"],
    "turtlebot3_navigation": ["param/base_local_planner_params.yaml"],
}


@pytest.fixture(scope="module")
def packages():
    """Where packages are."""
    return RosPack()


@pytest.mark.parametrize("package, name", [
    (package, name) for package, names in FILES.items() for name in names])
def test_it_is_there_and_can_be_included(packages, package, name, tmp_path):
    file = Path(packages.get_path(package), name)
    if file.suffix == ".yaml":
        assert yaml.safe_load(file.read_text(encoding="utf-8"))
        return
    own = tmp_path / "own.launch"
    own.write_text(f'<launch><include file="$(find {package})/{name}"/></launch>', encoding="utf-8")
    config = roslaunch.config.load_config_default([str(own)], None, verbose=False)
    assert not config.config_errors
    assert [node.package for node in config.nodes] == [
        "controller_manager" if package == "joint_state_controller" else package]


def test_the_joint_state_controller_is_loaded_where_it_is_included(tmp_path):
    own = tmp_path / "own.launch"
    own.write_text('<launch><group ns="arm"><include file="$(find joint_state_controller)/launch/'
                   'joint_state_controller.launch"/></group></launch>', encoding="utf-8")
    config = roslaunch.config.load_config_default([str(own)], None, verbose=False)
    values = {name: value.value for name, value in config.params.items()}
    assert values["/arm/joint_state_controller/type"] == (
        "joint_state_controller/JointStateController")
    assert values["/arm/joint_state_controller/publish_rate"] == 50
    assert (config.nodes[0].namespace, config.nodes[0].args) == ("/arm/", "joint_state_controller")
