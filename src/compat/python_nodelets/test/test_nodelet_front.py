"""Nodelets that launch files load: by Debian's program, or as a node of ours."""

import subprocess
from pathlib import Path

import pytest
from python_nodelets.front import INSTALLABLE, NODES, missing, node_instead
from roslib.packages import find_node

pytestmark = pytest.mark.processes


@pytest.mark.parametrize("words", [["manager"], ["unload", "a", "b"], ["load"], [],
                                   ["load", "image_proc/rectify", "manager"]])
def test_what_is_debians_stays_debians(words):
    assert node_instead(words) is None


@pytest.mark.parametrize("kind", sorted(NODES))
@pytest.mark.parametrize("how", [["load", "manager", "--no-bond"], ["standalone"]])
def test_a_node_takes_the_nodelets_names(kind, how):
    command = node_instead([how[0], kind, *how[1:], "image:=depth", "__name:=scan"])
    assert Path(command[0]).name == NODES[kind][1]
    assert command[1:] == ["image:=depth", "__name:=scan"]


def test_a_package_of_the_learners_with_the_real_nodelet_is_loaded(tmp_path, monkeypatch):
    package = tmp_path / "depthimage_to_laserscan"
    package.mkdir()
    (package / "package.xml").write_text(
        "<package><name>depthimage_to_laserscan</name><export>"
        "<nodelet plugin='${prefix}/nodelets.xml'/></export></package>", encoding="utf-8")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    kind = "depthimage_to_laserscan/DepthImageToLaserScanNodelet"
    assert node_instead(["load", kind, "manager"]) is None


@pytest.mark.parametrize("package", sorted(INSTALLABLE))
def test_what_debian_has_is_named_until_it_is_installed(package):
    there = Path(f"/usr/share/{package}/nodelet_plugins.xml").exists()
    line = missing(["load", f"{package}/anything", "manager"])
    assert line == "" if there else line.endswith(f"apt-get install {INSTALLABLE[package]}")
    assert missing(["manager"]) == missing(["load", "my_package/mine", "manager"]) == ""


@pytest.mark.parametrize("name", ["nodelet", "list_nodelets", "declared_nodelets"])
def test_each_program_of_the_package_is_found(name):
    assert find_node("nodelet", name)


def test_rosrun_starts_debians():
    ended = subprocess.run(["rosrun", "nodelet", "nodelet"], capture_output=True, text=True,
                           timeout=60, check=False)
    assert "nodelet usage" in ended.stdout + ended.stderr


@pytest.mark.parametrize("package, name", [
    ("topic_tools", name) for name in ("relay", "mux", "drop", "throttle", "transform")])
def test_topic_tools_are_found(package, name):
    assert find_node(package, name)
