"""Parameters, upstream's defaults, and the warning of ignored ones, by a server that is made up."""

import math
from pathlib import Path

import pytest
import yaml

from nav_nodes import parameters
from nav_nodes.ignored import ignored
from nav_nodes.parameters import Parameter, ParameterError, load_table, read_parameters

SCALE = Parameter("pdist_scale", "double", 0.6, min=0.0, also=("path_distance_bias",))


@pytest.fixture
def server(monkeypatch):
    """What is set, by name."""
    found = {}
    monkeypatch.setattr(parameters.rospy, "resolve_name", lambda name: name)
    monkeypatch.setattr(parameters.rospy, "has_param", found.__contains__)
    monkeypatch.setattr(parameters.rospy, "get_param", found.get)
    return found


@pytest.mark.parametrize("given, expected", [
    ({}, 0.6), ({"~pdist_scale": 1}, 1.0), ({"~path_distance_bias": 32.0}, 32.0),
    ({"~pdist_scale": 2.0, "~path_distance_bias": 32.0}, 2.0)])
def test_another_of_its_names_counts_where_its_own_is_not_set(server, given, expected):
    server.update(given)
    assert read_parameters([SCALE]) == {"pdist_scale": expected}


def test_a_wrong_value_is_blamed_on_the_name_that_it_has(server):
    server["~path_distance_bias"] = "32.0"
    with pytest.raises(ParameterError, match="~path_distance_bias is '32"):
        read_parameters([SCALE])


def test_a_whole_number_may_be_written_with_a_point():
    samples = Parameter("vx_samples", "int", 3, min=0, max=300)
    assert repr(samples.checked(20.0, "vx_samples")) == "20"
    for value in (20.5, math.inf, 301.0, True):
        with pytest.raises(ParameterError, match="vx_samples is"):
            samples.checked(value, "vx_samples")


@pytest.mark.parametrize("value", [True, "1", None, [1.0], -0.1, math.nan])
def test_what_is_no_such_number_is_refused(value):
    with pytest.raises(ParameterError, match="pdist_scale is"):
        SCALE.checked(value, "pdist_scale")


def test_a_list_is_text_where_text_is_wanted():
    """As in `footprint: [[0.1, 0.1], ...]` or `y_vels: [-0.3, 0.3]`."""
    outline = Parameter("footprint", "str", "[]")
    assert outline.checked([[0.1, 0.1], [-0.1, 0.1]], "x") == "[[0.1, 0.1], [-0.1, 0.1]]"


NAVIGATION = Path(__file__).resolve().parents[2]
GROUPS = yaml.safe_load(Path(__file__).with_name("upstream_defaults.yaml").read_text("utf-8"))
OFF = (0, 0.0, False)
OURS_ALONE = {"hybrid_astar.yaml", "pure_pursuit.yaml", "escape_recovery.yaml"}
NOT_POLICIES = {"lost_share_max": 1.0, "lost_forgets": True, "thin_wall": 0.3,
                "command_type": "twist", "wheelbase": 0.325}  # with these values it is upstream's
ROBUST = sorted(NAVIGATION.glob("*/config/robust.yaml"))


def entries_of(file):
    return {entry.name: entry for entry in load_table(NAVIGATION / file)}


@pytest.mark.parametrize("group", GROUPS, ids=lambda group: group["table"])
def test_defaults_are_upstream_s(group):
    entries = entries_of(group["table"])
    ours = {name: entry.default for name, entry in entries.items() if entry.ours}
    theirs = {name: entry.default for name, entry in entries.items() if not entry.ours}
    assert theirs == group["defaults"], group["source"]
    for name, default in ours.items():
        assert default == NOT_POLICIES[name] if name in NOT_POLICIES else default in OFF, name


def test_no_table_is_left_out():
    found = {str(file.relative_to(NAVIGATION)) for file in NAVIGATION.glob("*/params/*.yaml")
             if file.name not in OURS_ALONE}
    assert found == {group["table"] for group in GROUPS}


@pytest.mark.parametrize("file", ROBUST, ids=lambda file: file.parts[-3])
def test_what_our_launch_files_switch_on_is_ours(file):
    package = file.parts[-3]
    entries = entries_of(f"{package}/params/{package}.yaml")
    values = yaml.safe_load(file.read_text("utf-8"))
    for name, value in values.items():
        assert entries[name].ours and entries[name].checked(value, name) == value
    ours = {name for name, entry in entries.items() if entry.ours}
    assert ours - values.keys() <= {"command_type", "wheelbase", "seed"}


TABLES = {
    "": [Parameter("planner_frequency", "double", 0.0)],
    "DWAPlannerROS": [
        Parameter("max_vel_trans", "double", 0.55, was=("max_trans_vel",)),
        Parameter("pdist_scale", "double", 0.6, also=("path_distance_bias",)),
        Parameter("prune_plan", "bool", False, status="accepted", meaning="always"),
        Parameter("lstep", "double", 0.05, status="differs", meaning="a step")],
    "local_costmap/scan": [Parameter("topic", "str", "")],
    "local_costmap": [Parameter("width", "double", 10.0)],
}


@pytest.mark.parametrize("tree, said", [
    ({"planner_frequency": 1.0,
      "DWAPlannerROS": {"max_vel_trans": 1, "path_distance_bias": 1}}, []),
    ({"planer_frequency": 1.0}, ["planer_frequency (did you mean planner_frequency?)"]),
    ({"y_vels": "[]"}, ["y_vels"]),
    ({"DWAPlannerROS": {"max_trans_vel": 1.0}},
     ["DWAPlannerROS/max_trans_vel (now max_vel_trans)"]),
    ({"DWAPlannerROS": {"prune_plan": True}}, ["DWAPlannerROS/prune_plan (always)"]),
    ({"DWAPlannerROS": {"lstep": 0.1}},
     ["DWAPlannerROS/lstep (has another meaning: a step)"]),
    ({"DWAPlannerROS": {"prune_plan": False, "lstep": 0.05}}, []),
    ({"TebLocalPlannerROS": {"max_vel_x": 1.0}}, []),
    ({"DWAPlanerROS": {"max_vel_trans": 1.0}},
     ["DWAPlanerROS (did you mean DWAPlannerROS?)"]),
    ({"local_costmap": {"with": 3, "scan": {"topik": "scan"}}},
     ["local_costmap/with (did you mean width?)",
      "local_costmap/scan/topik (did you mean topic?)"]),
    ({"saved_pose": {"pose": []}}, []),
])
def test_what_is_said(tree, said):
    assert list(ignored(tree, TABLES, ["saved_pose"])) == said
