"""Packages that end in a raw error elsewhere: built unedited, or left out, as `check` said before.

`workspaces/errors.yaml` has one package for each cause that stopped public packages. The C++ is
compiled once, by catkin_make; the other tools build what needs no compiler.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml

pytestmark = pytest.mark.processes

ROOT = Path(__file__).resolve().parent.parent
ERRORS = yaml.safe_load((ROOT / "test/workspaces/errors.yaml").read_text(encoding="utf-8"))
PACKAGE = """<?xml version="1.0"?>
<package format="2">
  <name>{name}</name>
  <version>0.1.0</version>
  <description>{cause}</description>
  <maintainer email="learner@example.com">learner</maintainer>
  <license>BSD</license>
  <buildtool_depend>catkin</buildtool_depend>
{depends}</package>
"""
LIMIT = 600.0  # s, wall, on a busy machine
TOOLS = {
    "catkin_make": "catkin_make -j1 --no-color",
    "catkin_make_isolated": "catkin_make_isolated -j1 --no-color",
    "catkin build": "catkin build -p1 -j1 --no-status --no-color --no-notify",
}
COMPILED = ("error_bind", "error_console", "error_exports", "error_gtest", "error_header_bind",
            "error_undeclared")
REASONS = {
    "error_below": "Wibble: neither Debian nor this repository has it",
    "error_folder": "CMakeLists.txt:4: catkin_package() include dir 'include' does not exist",
    "error_message": "CMakeLists.txt:6: WIBBLE_HOME is not set; see the manual",
    "error_pkg_config": "libwibble: neither Debian nor this repository has it",
    "error_source": "CMakeLists.txt:5: Cannot find source file: src/nothing.cpp",
    "error_syntax": "CMakeLists.txt:3: Parse error. Function missing ending",
    "error_user": "error_message: it is left out itself",
    "error_without_components": "moveit_core: MoveIt is not in Debian",
    "gazebo_ros": "ours is used: the simulator is not Gazebo",
}
OF_CATKIN_MAKE = {"error_same_name": "target bound: error_bind has one of that name, too"}
PROGRAMS = {
    "rosrun error_bind bound": "bound 6.0",
    "rosrun error_undeclared undeclared": "centre 1",
    "rosrun error_exports exports": "exports 0",
    "rospack find gazebo_ros": str(ROOT / "src/compat/gazebo_ros"),
}


def in_terminal(command: str, setup: Path, home: Path) -> subprocess.CompletedProcess:
    """Runs a line in a terminal that has sourced a setup.bash; both streams in stdout."""
    kept = {name: os.environ[name] for name in ("LANG", "RUN_TESTS_MARK") if name in os.environ}
    return subprocess.run(
        ["bash", "-c", f". {setup}\n{command}"], text=True, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, timeout=LIMIT, check=False,
        env=kept | {"PATH": "/usr/local/bin:/usr/bin:/bin", "TERM": "dumb", "HOME": str(home)})


def write_packages(source: Path) -> None:
    """The packages of ERRORS."""
    for name, package in ERRORS.items():
        depends = "".join(f"  <depend>{each}</depend>\n" for each in package["depends"])
        manifest = PACKAGE.format(name=name, cause=package["cause"], depends=depends)
        for path, text in (package["files"] | {"package.xml": manifest}).items():
            (source / name / path).parent.mkdir(parents=True, exist_ok=True)
            (source / name / path).write_text(text, encoding="utf-8")


@pytest.fixture(scope="module")
def home(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("home")


@pytest.fixture(scope="module")
def checked(tmp_path_factory, home) -> str:
    """What check says of the workspace before it is built.

    Check and each tool find it as new, and at the same place: what CMake says of each package is
    kept of the first.
    """
    folder = tmp_path_factory.mktemp("catkin_ws", numbered=False)
    write_packages(folder / "src")
    done = in_terminal(f"rosrun bullet_sim_ros check {folder}", ROOT / "devel/setup.bash", home)
    shutil.rmtree(folder)
    assert done.returncode == 1, done.stdout
    return done.stdout


@pytest.fixture(scope="module", params=TOOLS)
def built(request, tmp_path_factory, home, checked) -> tuple[Path, str, str]:
    """The workspace's folder, the tool and what it printed."""
    folder = tmp_path_factory.mktemp("catkin_ws", numbered=False)
    request.addfinalizer(lambda: shutil.rmtree(folder))
    write_packages(folder / "src")
    if request.param != "catkin_make":
        for name in COMPILED:
            shutil.rmtree(folder / "src" / name)
    done = in_terminal(f"cd {folder} && {TOOLS[request.param]}", ROOT / "devel/setup.bash", home)
    assert done.returncode == 0, done.stdout[-4000:]
    return folder, request.param, done.stdout


def expected(tool: str) -> dict[str, str]:
    return REASONS | (OF_CATKIN_MAKE if tool == "catkin_make" else {})


@pytest.mark.timeout(LIMIT + 60)  # the first one, which the build comes before
def test_each_package_that_fails_is_left_out_with_its_reason(built):
    _, tool, said = built
    lines = dict(re.findall(r"^(\S+) is left out: (.*)", said, re.MULTILINE))
    assert lines.keys() == expected(tool).keys()
    for name, reason in expected(tool).items():
        assert lines[name].startswith(reason), lines[name]
    assert "CMake Error" not in said


def test_check_says_before_what_the_build_says_after(checked, built):
    said, flat = built[2], " ".join(checked.split())
    for name, why in re.findall(r"^(\S+) is left out: (.*)", said, re.MULTILINE):
        assert f"package {name} " in flat and " ".join(why.split()) in flat, why
    assert flat.count("it is left out:") == len(expected("catkin_make"))
    target, why = re.search(r"target (\S+) is left out: (.*?)\. What", said).groups()
    assert f"target {target}: left out: {why}" in flat


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
@pytest.mark.parametrize("command", PROGRAMS)
def test_the_rest_is_built_unedited_and_runs(built, home, command):
    done = in_terminal(command, built[0] / "devel/setup.bash", home)
    assert PROGRAMS[command] in done.stdout, done.stdout


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
def test_what_is_found_undeclared_is_said_once(built):
    assert built[2].count("does not name kobuki_msgs in find_package") == 1


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
def test_a_second_build_says_the_same_and_keeps_the_clone_as_it_is(built, home):
    folder, tool, said = built
    clone = {path.name for path in (folder / "src/gazebo_ros").iterdir()}
    assert clone == {"package.xml", "CMakeLists.txt", "CATKIN_IGNORE"}
    again = in_terminal(f"cd {folder} && {TOOLS[tool]}", ROOT / "devel/setup.bash", home)
    assert again.returncode == 0
    assert re.findall(r"^.* is left out: .*", again.stdout, re.MULTILINE)[:len(expected(tool))] == (
        re.findall(r"^.* is left out: .*", said, re.MULTILINE)[:len(expected(tool))])


def test_vtks_headers_are_found_with_pcls(tmp_path, home):
    """pcl_ros of Debian exports PCL's headers, and not those of VTK, which they include."""
    for path in ("include/pcl/visualization/viewer.h", "include/vtk-9.1/vtkObject.h"):
        (tmp_path / path).parent.mkdir(parents=True)
        (tmp_path / path).touch()
    (tmp_path / "view.cpp").write_text("#include <pcl/visualization/viewer.h>\n")
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.0.2)\nproject(view)\nadd_library(view view.cpp)\n")
    hook = ROOT / "src/interfaces/missing_headers/cmake/missing_headers.cmake"
    done = in_terminal(f"cmake -S {tmp_path} -B {tmp_path}/b -DCMAKE_PROJECT_INCLUDE={hook} "
                       f"-DMISSING_HEADERS_SYSTEM={tmp_path}/include",
                       ROOT / "devel/setup.bash", home)
    assert done.returncode == 0, done.stdout
    flags = (tmp_path / "b/CMakeFiles/view.dir/flags.make").read_text()
    assert f"-I{tmp_path}/include/vtk-9.1" in flags
