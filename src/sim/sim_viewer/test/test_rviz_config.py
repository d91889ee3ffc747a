"""rviz's files: every one of the repository, what is unknown in one, and what is broken."""

import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from sim_viewer.rviz.config import BEGINNING, ConfigError, beginning, parse, read_config
from sim_viewer.rviz.options import check_all, defaults
from sim_viewer.rviz.types import TYPES

ROOT = Path(__file__).resolve().parents[4]
SCRIPT = ROOT / "src/sim/sim_viewer/scripts/rviz_page"
FILES = [ROOT / name for name in subprocess.run(
    ["git", "ls-files", "*.rviz"], cwd=ROOT, capture_output=True, text=True,
    check=True).stdout.split()]


def test_every_default_is_one_that_its_option_allows():
    for kind in TYPES.values():
        assert check_all(kind.options, defaults(kind.options)) == defaults(kind.options)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_every_file_of_the_repository_is_shown(path):
    config = read_config(path)
    assert config["fixed_frame"] and config["displays"]
    strange = {one["class"] for one in config["displays"] if not one["supported"]}
    assert strange <= {"somebody/Else"}  # of the test's own file
    assert not [one["warnings"] for one in config["displays"] if one["warnings"]]


def manager(*displays, **more):
    return {"Visualization Manager": {"Displays": list(displays), **more}}


def test_nested_properties_topics_and_groups_are_read():
    config = parse(manager(
        {"Class": "rviz/Group", "Name": "Off", "Enabled": False, "Displays": [
            {"Class": "rviz/Odometry", "Name": "O", "Enabled": True, "Topic": "/robot/odom",
             "Shape": {"Value": "Axes", "Color": "1; 2; 3", "Axes Length": 0.5},
             "Covariance": {"Value": False, "Position": {"Value": True, "Scale": 3}}}]},
        {"Class": "rviz/Marker", "Marker Topic": "/m", "Namespaces": {"a": False}},
        Tools=[{"Class": "rviz/SetGoal", "Topic": "/robot/goal"}]))
    odometry, marker = config["displays"]
    assert (odometry["enabled"], odometry["topic"]) == (False, "/robot/odom")
    options = odometry["options"]
    assert (options["Shape"], options["Color"], options["Axes Length"]) == ("Axes", "1; 2; 3", 0.5)
    assert options["Covariance/Value"] is False and options["Covariance/Position/Scale"] == 3
    assert (marker["topic"], marker["options"]) == ("/m", {"Namespaces": {"a": False}})
    assert config["topics"]["goal"] == "/robot/goal"
    assert config["topics"]["initial_pose"] == "/initialpose"


def test_what_is_unknown_becomes_an_entry_and_a_wrong_value_a_warning():
    config = parse(manager({"Class": "jsk/Pie", "Name": "P"},
                           {"Class": "rviz/Grid", "Alpha": "much", "Color": "1; 2"}))
    strange, grid = config["displays"]
    assert (strange["supported"], strange["name"]) == (False, "P")
    assert grid["options"] == defaults(TYPES["rviz/Grid"].options)
    assert grid["warnings"] == ["Color is '1; 2', which is not a colour such as 255; 0; 0",
                                "Alpha is 'much', which is not a number from 0 to 1"]


@pytest.mark.parametrize("text, said", [
    ("a: [1", "line 1: this is not valid YAML"), ("[]", "there is no `Visualization Manager:`"),
    ("Visualization Manager: {Displays: 3}", "Displays is not a list"),
    ("Visualization Manager: {Displays: [{Name: a}]}", "entry 1 has no Class"),
    ("Visualization Manager: {Global Options: 1}", "Global Options is not a mapping"),
    ("Visualization Manager: {Displays: &a [{Class: rviz/Group, Displays: *a}]}",
     "line 1: this is not valid YAML: anchors (&) and aliases (*) are not allowed here"),
    ("Visualization Manager: {Displays: [&a {Class: rviz/Grid, Offset: *a}]}",
     "anchors (&) and aliases (*) are not allowed here"),
    ("Date: 2001-13-01", "this is not valid YAML: month must be in 1..12"),
    ("a: !!int ''", "this is not valid YAML"), ("a: !!bool x", "this is not valid YAML"),
    ("a" * (1 << 20) + "b", "is larger than 1048576 bytes"),
    ("\0", "this is not valid YAML"), (b"\xff\xfe\x80", "is not text"),
    ("Visualization Manager: {Displays: [" + "{Class: rviz/Grid}," * 51 + "]}", "51 displays"),
])
def test_a_broken_file_is_one_line(tmp_path, monkeypatch, text, said):
    path = tmp_path / "broken.rviz"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    monkeypatch.setattr(sys, "argv", [str(SCRIPT), "-d", str(path)])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(SCRIPT), run_name="__main__")
    line = ended.value.code
    assert line.startswith(f"rviz_page: {path}") and said in line and "\n" not in line


def test_a_missing_file_is_named():
    with pytest.raises(ConfigError, match=r"/none\.rviz: No such file or directory"):
        read_config("/none.rviz")


def test_without_a_file_there_are_a_few_displays():
    assert [one["class"] for one in beginning()["displays"]] == list(BEGINNING)
