"""What the parameters of a costmap mean, in both styles."""

import numpy as np
import pytest

from costmap_2d import settings
from costmap_2d.costmap_ros import build_layer, change_layer
from nav_algorithms.costmap.inflation import InflationLayer
from nav_algorithms.costmap.obstacles import ObstacleLayer
from nav_algorithms.costmap.static import StaticLayer
from nav_algorithms.costmap.voxels import VoxelLayer
from nav_nodes.parameters import ParameterError

WHERE = "/move_base/local_costmap"
TURTLEBOT3 = {
    "obstacle_range": 3.0, "raytrace_range": 3.5, "inflation_radius": 1.0,
    "cost_scaling_factor": 3.0, "map_type": "costmap", "observation_sources": "scan",
    "footprint": [[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]],
    "scan": {"sensor_frame": "base_scan", "data_type": "LaserScan", "topic": "scan",
             "marking": True, "clearing": True},
    "global_frame": "odom", "robot_base_frame": "base_footprint", "update_frequency": 10.0,
    "publish_frequency": 10.0, "transform_tolerance": 0.5, "static_map": False,
    "rolling_window": True, "width": 3, "height": 3, "resolution": 0.05}


def read(tree, **outer):
    return settings.settings_of(tree, WHERE, outer)


def test_the_older_style_of_turtlebot3():
    found = read(TURTLEBOT3)
    assert [(layer.name, layer.kind) for layer in found.layers] == [
        ("obstacle_layer", "ObstacleLayer"), ("inflation_layer", "InflationLayer")]
    obstacles, inflation = found.layers
    assert obstacles.sources["scan"] == {
        **obstacles.sources["scan"], "topic": "scan", "sensor_frame": "base_scan",
        "data_type": "LaserScan", "marking": True, "clearing": True, "obstacle_range": 3.0,
        "raytrace_range": 3.5, "inf_is_valid": False}
    assert inflation.values["inflation_radius"] == 1.0
    assert inflation.values["cost_scaling_factor"] == 3.0
    assert found.values["width"] == 3.0 and found.values["rolling_window"]
    assert settings.footprint_of(found.values, WHERE) == pytest.approx(
        np.array(TURTLEBOT3["footprint"]))


@pytest.mark.parametrize("tree, has_map", [
    ({}, False), ({"static_map": True}, True), ({"static_map": False}, False),
    ({"rolling_window": True, "static_map": True}, True)])
def test_when_the_older_style_has_a_map(tree, has_map):
    assert ("static_layer" in [layer.name for layer in read(tree).layers]) == has_map


def test_older_parameters_reach_their_layers():
    tree = {"static_map": True, "map_type": "voxel", "map_topic": "other", "unknown_cost_value": 7,
            "lethal_cost_threshold": 60, "track_unknown_space": True, "z_voxels": 5,
            "mark_threshold": 2, "max_obstacle_height": 1.1, "observation_sources": "a b",
            "a": {"obstacle_range": 1.0}}
    static, voxels, _ = read(tree).layers
    assert static.values["map_topic"] == "other" and static.values["unknown_cost_value"] == 7
    assert static.values["lethal_cost_threshold"] == 60
    assert voxels.kind == "VoxelLayer" and voxels.values["z_voxels"] == 5
    assert voxels.values["mark_threshold"] == 2 and voxels.values["track_unknown_space"]
    assert voxels.values["max_obstacle_height"] == 1.1
    assert voxels.sources["a"]["obstacle_range"] == 1.0
    assert voxels.sources["b"]["topic"] == "b" and voxels.sources["b"]["obstacle_range"] == 2.5


def test_the_style_with_plugins_reads_each_layers_own_namespace():
    tree = {"plugins": [{"name": "walls", "type": "costmap_2d::StaticLayer"},
                        {"name": "lasers", "type": "costmap_2d::ObstacleLayer"},
                        {"name": "soft", "type": "costmap_2d::InflationLayer"}],
            "walls": {"map_topic": "/map2", "first_map_only": True},
            "lasers": {"observation_sources": "front", "obstacle_range": 4.0,
                       "front": {"data_type": "PointCloud2", "raytrace_range": 9.0}},
            "soft": {"inflation_radius": 0.3}, "track_unknown_space": True}
    walls, lasers, soft = read(tree).layers
    assert walls.values["map_topic"] == "/map2" and walls.values["first_map_only"]
    front = lasers.sources["front"]
    assert (front["data_type"], front["obstacle_range"], front["raytrace_range"]) == (
        "PointCloud2", 4.0, 9.0)
    assert lasers.values["track_unknown_space"] and soft.values["inflation_radius"] == 0.3


def test_a_costmaps_own_value_wins_over_its_layers_as_upstream():
    tree = {"plugins": [{"name": "soft", "type": "costmap_2d::InflationLayer"}],
            "soft": {"inflation_radius": 0.3}, "inflation_radius": 0.9}
    assert read(tree).layers[0].values["inflation_radius"] == 0.9


def test_some_parameters_are_searched_upwards():
    tree = {"observation_sources": "scan", "raytrace_range": 3.5}
    found = read(tree, footprint="[[1, 1], [-1, 1], [0, -1]]", obstacle_range=1.5,
                 raytrace_range=9.0, width=77.0)
    scan = found.layers[0].sources["scan"]
    assert (scan["obstacle_range"], scan["raytrace_range"]) == (1.5, 3.5)
    assert settings.footprint_of(found.values, WHERE).tolist() == [[1, 1], [-1, 1], [0, -1]]
    assert found.values["width"] == 10.0


@pytest.mark.parametrize("text", ["!!int ''", "!!bool x", "[" * 1000, "2020-13-45", "{a: 1}"])
def test_a_footprint_that_yaml_cannot_read_is_one_line(text):
    with pytest.raises(ParameterError, match=r"footprint is [^\n]{1,300}$"):
        settings.footprint_of({"footprint": text}, WHERE)


def test_an_unknown_layer_is_left_out_with_a_line():
    found = read({"plugins": [{"name": "sonar", "type": "range_sensor_layer::RangeSensorLayer"},
                              {"name": "i", "type": "costmap_2d::InflationLayer"}]})
    assert [layer.name for layer in found.layers] == ["i"]
    assert "sonar" in found.warnings[0] and "costmap_2d::VoxelLayer" in found.warnings[0]


@pytest.mark.parametrize("changed", [{"width": 6e9}, {"height": 9e3, "width": 9e3},
                                     {"width": float("inf")}])
def test_more_cells_than_there_is_room_for_are_refused(changed):
    found = read({**TURTLEBOT3, "width": 2, "height": 3})
    assert settings.geometry_of(found.values, WHERE)[0] == (60, 40)
    with pytest.raises(ParameterError, match="/move_base/local_costmap/width is"):
        settings.geometry_of({**found.values, **changed}, WHERE)


@pytest.mark.parametrize("tree, line", [
    ({"update_frequency": "fast"}, "/move_base/local_costmap/update_frequency is 'fast'"),
    ({"inflation_layer": {"inflation_radius": -1}}, "inflation_layer/inflation_radius is -1"),
    ({"observation_sources": "s", "s": {"data_type": "Sonar"}}, "obstacle_layer/s/data_type"),
    ({"plugins": ["StaticLayer"]}, "must be a list of"), ({"plugins": 3}, "must be of type list")])
def test_nonsense_is_named(tree, line):
    with pytest.raises(ParameterError, match=line):
        read(tree)


@pytest.mark.parametrize("text", ["[]", "", "[[]]"])
def test_no_footprint(text):
    assert settings.footprint_of({"footprint": text}, WHERE) is None


@pytest.mark.parametrize("text", ["[[1, 1], [2, 2]]", "[[1, 2, 3], [1, 2, 3], [1, 2, 3]]", "round",
                                  "[[0, 1], [1, .nan], [1, 0]]", "[1, 2", "7"])
def test_a_footprint_that_is_none(text):
    with pytest.raises(ParameterError, match="three or more corners"):
        settings.footprint_of({"footprint": text}, WHERE)


@pytest.mark.parametrize("language", ["README.md", "README.zh-CN.md"])
def test_every_parameter_stands_in_the_readme(language):
    text = (settings.PARAMS.parent / language).read_text(encoding="utf-8")
    known = [entry for path in settings.PARAMS.glob("*.yaml") for entry in
             settings.table(path.stem)]
    assert [entry.name for entry in known if f"`{entry.name}`" not in text] == []
    tail = text[text.index("no effect" if language == "README.md" else "没有作用"):]
    assert [entry.name for entry in known
            if entry.status == "accepted" and f"`{entry.name}`" not in tail] == []


def test_layers_are_built_and_changed():
    tree = {"plugins": [{"name": name, "type": f"costmap_2d::{name}"} for name in settings.TABLES],
            "VoxelLayer": {"z_voxels": 4}}
    found = read(tree).layers
    layers = [build_layer(layer, rolling=True) for layer in found]
    assert [type(layer) for layer in layers] == [StaticLayer, ObstacleLayer, VoxelLayer,
                                                 InflationLayer]
    assert layers[2].settings.z_voxels == 4
    change_layer(layers[2], {**found[2].values, "z_voxels": 7, "enabled": False,
                             "max_obstacle_height": 0.5})
    assert layers[2].settings.z_voxels == 7 and not layers[2].enabled
    assert layers[2].max_obstacle_height == 0.5
