"""The launch files: they parse, what they name exists, and no parameter is one nobody reads."""

from pathlib import Path

import pytest
import roslaunch.config
import roslaunch.xmlloader
import yaml

PACKAGE = Path(__file__).resolve().parents[1]
NAVIGATION = PACKAGE.parents[1] / "navigation"
LAUNCHES = sorted(PACKAGE.glob("launch/*.launch"))
STATE = {"/joint_state_publisher", "/robot_state_publisher"}
NODES = {  # launch: the nodes it starts where there is no screen
    "nav01_slam": {"/slam_gmapping", *STATE}, "map_save": {"/map_save"},
    "nav03_map_server": {"/map_server"}, "nav04_amcl": {"/amcl"},
    "nav04_test": {"/map_server", "/amcl", *STATE}, "nav05_path": {"/move_base"},
    "nav05_test": {"/map_server", "/amcl", "/move_base", *STATE},
    "nav05_robust": {"/map_server", "/amcl", "/move_base", *STATE},
    "nav07_own_planner": {"/map_server", "/amcl", "/move_base", *STATE},
    "nav06_auto_slam": {"/slam_gmapping", "/move_base", *STATE},
}
RVIZ = {"nav01_slam": "map", "nav03_map_server": "map", "nav04_test": "map", "nav05_test": "nav",
        "nav05_robust": "nav", "nav06_auto_slam": "nav",
        "nav07_own_planner": "nav"}  # launch: the configuration
COSTMAP = ("costmap", "static_layer", "obstacle_layer", "inflation_layer")


def load(name, *arguments):
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load(str(PACKAGE / "launch" / f"{name}.launch"), config,
                                         argv=list(arguments), verbose=False)
    return {f"{node.namespace}{node.name}": node for node in config.nodes}, config.params


def table(package, name):
    text = (NAVIGATION / package / "params" / f"{name}.yaml").read_text(encoding="utf-8")
    return {row["name"] for row in yaml.safe_load(text)}


def test_every_launch_file_is_listed():
    assert {path.stem for path in LAUNCHES} == set(NODES)


@pytest.mark.parametrize("display, rviz", [("", set()), (":0", {"/rviz"})])
@pytest.mark.parametrize("name", NODES)
def test_nodes(name, display, rviz, monkeypatch):
    monkeypatch.setenv("DISPLAY", display)
    shows = name in RVIZ
    nodes = load(name)[0]
    assert set(nodes) == NODES[name] | (rviz if shows else set())
    if "/rviz" in nodes:
        config = Path(nodes["/rviz"].args.split()[1])
        assert config.stem == RVIZ[name] and config.is_file()


def test_maps_are_given_by_name_or_by_path():
    for name in ("nav03_map_server", "nav04_test", "nav05_test"):
        assert Path(load(name)[0]["/map_server"].args).is_file()
        assert load(name, "map_file:=/x/y.yaml")[0]["/map_server"].args == "/x/y.yaml"
    assert load("nav03_map_server", "map:=my_map.yaml")[0]["/map_server"].args.endswith(
        "/map/my_map.yaml")


@pytest.mark.parametrize("name", ["nav01_slam", "nav04_test", "nav05_test", "nav06_auto_slam"])
def test_the_state_publishers_can_be_left_to_the_car(name):
    assert set(load(name, "state_publishers:=false", "rviz:=false")[0]) == NODES[name] - STATE


def test_parameters_are_known():
    """A misspelt name would be silently without effect."""
    known = {
        "/slam_gmapping/": table("gmapping", "slam_gmapping"),
        "/amcl/": table("amcl", "amcl"),
        "/move_base/": table("move_base", "move_base"),
        "/move_base/TrajectoryPlannerROS/": table("move_base", "trajectory_planner"),
        "/move_base/local_costmap/": set().union(*(table("costmap_2d", name) for name in COSTMAP)),
        "/move_base/local_costmap/scan/": table("costmap_2d", "source"),
    }
    known |= {space.replace("local", "global"): names for space, names in known.items()}
    given = load("nav05_robust")[1] | load("nav06_auto_slam")[1] | load("nav07_own_planner")[1]
    assert given["/move_base/base_global_planner"].value == "nav_demo/BreadthFirst"
    for name in given:
        space, _, last = name.rpartition("/")
        if space and space != "/joint_state_publisher":
            assert last in known[f"{space}/"], name
