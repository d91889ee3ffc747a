"""The keys: made from Debian's lists to the byte, and those that are shipped."""

import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from workspace_needs.debian_lists import read_packages, ros_packages
from workspace_needs.places import release
from workspace_needs.tables import TableError, Tables, read_absences, read_modules

from workspace_needs import key_files

ROOT = Path(__file__).resolve().parents[3]
PACKAGES = """\
Package: libbeep-dev
Source: ros-beep (1.2-3)
Section: libdevel
Depends: libbeep1d (= 1.2), ros-beep-msgs | other

Package: libbeep1d
Source: ros-beep
Section: libs

Package: ros-beep-msgs
Source: ros-beep
Section: devel

Package: python3-beep
Source: ros-beep
Section: python
Depends: python3:any

Package: cl-beep
Source: ros-beep
Section: lisp

Package: libtone2-dev
Section: libdevel
Provides: libtone-dev (= 2)
"""
CONTENTS = """\
usr/include/beep/beep.h                              libdevel/libbeep-dev
usr/lib/python3/dist-packages/beep/__init__.py       python/python3-beep
usr/lib/x86_64-linux-gnu/cmake/tone/toneConfig.cmake libdevel/libtone2-dev
usr/share/beep/cmake/beepConfig.cmake                libdevel/libbeep-dev
usr/share/beep/msg/Beep.msg                          devel/ros-beep-msgs
usr/share/beep/package.xml                           libdevel/libbeep-dev,libs/libbeep1d
usr/share/common-lisp/ros/beep/beep.asd              lisp/cl-beep
usr/share/beep/beep.lisp                             lisp/cl-beep
"""


def made(packages: str = PACKAGES, contents: str = CONTENTS, **system) -> str:
    binaries = read_packages(packages.splitlines(keepends=True))
    ros = ros_packages(contents.splitlines(keepends=True), binaries)
    keys = key_files.debian_keys({"a": (ros, binaries), "b": ({}, {})}, system)
    return key_files.debian_text(keys, ["a", "b"])


def test_parts_of_a_ros_package():
    """Headers and Python; not the library that they need, nor Lisp."""
    assert "beep: {debian: {a: [libbeep-dev, python3-beep], b: null}}\n" in made()


def test_the_same_lists_make_the_same_bytes_in_any_order():
    system = dict(keys={"tone": ["none|libtone-dev"]}, python=[["beep"]],
                  groups={"all": ["beep", "tone"]})
    shuffled = "\n\n".join(reversed(PACKAGES.strip().split("\n\n")))
    lines = "".join(reversed(CONTENTS.splitlines(keepends=True)))
    assert made(**system) == made(shuffled, lines, **system)
    keys = yaml.safe_load(made(**system))
    assert keys["tone"] == {"debian": {"a": ["libtone-dev"], "b": None}}
    assert keys["python-beep"]["debian"]["a"] == ["python3-beep"]
    assert keys["all"]["debian"] == {"a": ["libbeep-dev", "libtone-dev", "python3-beep"], "b": []}


def test_what_no_release_has_is_an_error():
    with pytest.raises(key_files.KeyFileError, match="no release has what these keys ask for: x"):
        made(keys={"x": ["libnone"]})
    with pytest.raises(key_files.KeyFileError, match="group g: there is no key y"):
        made(groups={"g": ["y"]})
    with pytest.raises(key_files.KeyFileError, match=r"s\.yaml: unknown section 'kyes'"):
        key_files.check_system_keys({"kyes": {}}, "s.yaml")


def test_rows_of_what_is_absent_are_checked(tmp_path):
    path = tmp_path / "absent.yaml"
    path.write_text("- {what: a, why: b, key: [c]}", encoding="utf-8")
    with pytest.raises(TableError, match="row 1: unknown key 'key'"):
        read_absences(path)


def test_every_package_of_ours_has_a_key():
    subprocess.run([sys.executable, str(ROOT / "scripts/rosdep_keys.py"), "--ours", "--check"],
                   check=True, timeout=60)


def has_provider(name: str) -> bool:
    """Whether another package provides it, as libqt5gui5t64 does libqt5gui5 in Debian 13."""
    told = subprocess.run(["apt-cache", "showpkg", name], capture_output=True, text=True,
                          check=True)
    return bool(told.stdout.partition("Reverse Provides:")[2].strip())


def test_every_key_is_a_package_that_apt_knows():
    known = set(subprocess.run(["apt-cache", "pkgnames"], capture_output=True, text=True,
                               check=True).stdout.split())
    if "libroscpp-dev" not in known:
        pytest.skip("apt has no lists here")
    asked = {name for rule in Tables().debian.values()
             for name in rule["debian"].get(release()) or ()}
    assert len(asked) > 900
    assert [name for name in sorted(asked - known) if not has_provider(name)] == []


@pytest.mark.parametrize("key, meant", [
    ("rospyy", "rospy"), ("std_msg", "std_msgs"), ("robot_localisation", "robot_localization"),
    ("controller_manger", "controller_manager"), ("python-numpi", "python-numpy")])
def test_what_is_mistyped_is_named_right(key, meant):
    assert Tables().answer(key).why.endswith(f"is {meant} meant?")


@pytest.mark.parametrize("key", [
    "compressed_image_transport", "costmap_2d_plugins", "hector_nav_msgs", "mbf_msgs", "nav2d",
    "nav_2d_msgs", "turtlebot2_gazebo", "turtlebot3_applications", "tf2_web_republisher",
    "image_publisher", "rosbridge_msgs", "navfn2", "yocs_msgs", "map_merger", "gazebo2rviz"])
def test_the_name_of_another_package_is_not_said_to_be_mistyped(key):
    assert "meant?" not in Tables(of_release="bookworm").answer(key).why


@pytest.mark.parametrize("key, instead", [
    ("rosserial_python", "its drive and sensors"), ("slam_karto", "gmapping"),
    ("frontier_exploration", "move_base"), ("explore_lite", "move_base"),
    ("map_merge", "/tb3_0/map")])
def test_what_there_is_instead_of_a_node_that_nobody_has(key, instead):
    assert instead in Tables().answer(key).why


@pytest.mark.parametrize("key, package", [
    ("bfl", "liborocos-bfl-dev"), ("roscpp", "libroscpp-dev"), ("cv_bridge", "libcv-bridge-dev"),
    ("eigen", "libeigen3-dev"),
    ("cv_bridge", "python3-cv-bridge"), ("python-numpy", "python3-numpy"), ("sdl", "libsdl1.2-dev"),
    ("nodelet", "libnodeletlib-dev"), ("common_msgs", "libnav-msgs-dev"), ("tf", "libtf-dev"),
    ("libpcl-all-dev", "libpcl-dev"), ("opencv3", "libopencv-dev"), ("yaml-cpp", "libyaml-cpp-dev"),
])
def test_well_known_keys(key, package):
    assert package in Tables(of_release="bookworm").answer(key).packages
    assert package in Tables(of_release="trixie").answer(key).packages


@pytest.mark.parametrize("text, said", [
    ("renamed: {a: b}\npackages: {}\nmore: {}\n", "m.yaml: unknown key 'more'; there are renamed, "
                                                 "packages"),
    ("renamed: {a: b}\n", "m.yaml: packages is missing"),
    ("renamed: {a: 1}\npackages: {}\n", "m.yaml, renamed: 'a' and 1 must be names")])
def test_what_is_wrong_with_a_file_of_modules_is_named(tmp_path, text, said):
    (tmp_path / "m.yaml").write_text(text)
    with pytest.raises(TableError) as raised:
        read_modules(tmp_path / "m.yaml")
    assert str(raised.value) == said
