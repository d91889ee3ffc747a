"""The three build tools on a small workspace that asks for what nobody has; and without one."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes

ROOT = Path(__file__).resolve().parent.parent
TOOLS = {
    "catkin_make": "catkin_make --no-color",
    "catkin_make_isolated": "catkin_make_isolated --no-color",
    "catkin build": "catkin build --no-status --no-color --no-notify",
}
MANIFEST = """<?xml version="1.0"?>
<package format="2"><name>{name}</name><version>1.0.0</version><description>d</description>
<maintainer email="who@example.com">who</maintainer><license>BSD</license>
<buildtool_depend>catkin</buildtool_depend>{depends}</package>
"""
GUARDED = """/*
#include <gazebo/physics/physics.hh>
*/
#ifdef WITH_GAZEBO
#include <gazebo/gazebo.hh>
#endif
int main() { return 0; }
"""


def add(source: Path, name: str, components: str, rest: str = "", **files: str) -> None:
    """A package; `files` are its src/NAME.cc."""
    folder = source / name
    (folder / "src").mkdir(parents=True)
    depends = "".join(f"<depend>{key}</depend>" for key in components.split())
    (folder / "package.xml").write_text(MANIFEST.format(name=name, depends=depends))
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.0.2)\nproject({name})\n"
        f"find_package(catkin REQUIRED COMPONENTS {components})\n{rest or 'catkin_package()'}\n")
    for file, text in files.items():
        (folder / "src" / f"{file}.cc").write_text(text)


def in_terminal(line: str) -> subprocess.CompletedProcess:
    """Runs a line in a new terminal that has sourced the workspace; both streams in stdout."""
    kept = {name: os.environ[name] for name in ("HOME", "ROS_HOME", "RUN_TESTS_MARK")
            if name in os.environ}
    return subprocess.run(["bash", "-c", f". {ROOT}/devel/setup.bash\n{line}"], text=True,
                          env=kept | {"PATH": "/usr/local/bin:/usr/bin:/bin", "TERM": "dumb"},
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=120)


@pytest.fixture(scope="module")
def place(tmp_path_factory) -> Path:
    """Where all workspaces are, so that what CMake says of each package is kept for the next."""
    return tmp_path_factory.mktemp("place") / "ws"


@pytest.fixture
def workspace(place) -> Iterator[Path]:
    """The folder of a workspace that is not there yet."""
    yield place
    shutil.rmtree(place)


@pytest.fixture(scope="module", params=TOOLS)
def built(request, place) -> tuple[Path, str]:
    """The workspace, aside from where it was built, and what the tool printed."""
    folder = place
    source = folder / "src"
    add(source, "arm", "moveit_core")
    add(source, "hand", "arm")
    add(source, "wheel", "rospy")
    add(source, "guarded", "gazebo_ros roscpp",
        "catkin_package()\nadd_executable(guarded_node src/node.cc)", node=GUARDED)
    add(source, "effects", "gazebo_ros roscpp",
        "catkin_package(INCLUDE_DIRS include CATKIN_DEPENDS gazebo_ros)")
    (source / "effects/include/effects").mkdir(parents=True)
    (source / "effects/include/effects/a.h").write_text("#include <gazebo/gazebo.hh>\n")
    add(source, "uses_effects", "effects roscpp",
        "catkin_package()\ninclude_directories(${catkin_INCLUDE_DIRS})\n"
        "add_executable(effect src/node.cc)",
        node="#include <effects/a.h>\nint main() { return 0; }\n")
    done = in_terminal(f"cd {folder} && {TOOLS[request.param]}")
    assert done.returncode == 0, done.stdout[-4000:]
    return folder.rename(folder.with_name(request.param.replace(" ", "_"))), done.stdout


def test_what_nobody_has_is_left_out_in_a_line_and_the_rest_is_built(built):
    lines = [line for line in built[1].splitlines()
             if " is left out: " in line and "target" not in line]
    assert [line.split()[0] for line in lines] == ["arm", "hand"] * 2  # and again at the end
    assert built[1].splitlines()[-2:] == lines[2:] == lines[:2]
    assert lines[0].startswith("arm is left out: moveit_core: MoveIt is not in Debian")
    names = {path.parent.name for path in built[0].glob("devel*/**/share/*/cmake")}
    assert {"wheel", "guarded", "uses_effects"} <= names and not {"arm", "hand"} & names


def test_a_header_in_a_comment_or_behind_a_condition_leaves_nothing_out(built):
    assert "guarded_node is left out" not in built[1]


def test_a_missing_header_is_found_through_another_packages_header(built):
    assert built[1].count("target effect is left out: ") == 1
    assert "include/effects/a.h includes <gazebo/gazebo.hh>" in built[1]


@pytest.mark.parametrize("line, built", [
    *((line, "") for line in TOOLS.values()),
    ("catkin_make --only-pkg-with-deps arm", "wheel"),
    ("catkin_make --pkg arm", "wheel")])  # which ends with make's own error
def test_a_build_that_leaves_out_all_that_was_asked_for_has_failed(workspace, line, built):
    add(workspace / "src", "arm", "moveit_core")
    if built:
        add(workspace / "src", built, "rospy")
    done = in_terminal(f"cd {workspace} && {line}")
    *_, before, last = done.stdout.splitlines()
    assert done.returncode == 1 and "arm is left out: moveit_core: " in before + last, done.stdout
    assert "No such file" in done.stdout or last == (
        "nothing of your own is built: each package that was asked for is left out, see above")


@pytest.mark.parametrize("tool", TOOLS)
def test_a_package_xml_that_cannot_be_read_is_one_line(workspace, tool):
    add(workspace / "src", "wheel", "rospy")
    add(workspace / "src", "bad", "rospy")
    manifest = workspace / "src/bad/package.xml"
    manifest.write_text(manifest.read_text().replace("who@example.com", "nobody"))
    done = in_terminal(f"cd {workspace} && {TOOLS[tool]}")
    said = done.stdout.splitlines()[-1]
    assert done.returncode == 1 and "Traceback" not in done.stdout
    assert said.startswith(f"{tool}: ") and "bad/package.xml: Invalid email" in said


def test_catkins_settings_and_environment_are_left_alone(workspace):
    add(workspace / "src", "arm", "moveit_core")
    add(workspace / "src", "wheel", "rospy")
    done = in_terminal(f"cd {workspace} && {TOOLS['catkin build']} --save-config && catkin config")
    assert done.returncode == 0, done.stdout
    assert done.stdout.rindex("Skiplisted Packages:         None") > done.stdout.index("Summary")
    done = in_terminal(f"cd {workspace} && catkin build --get-env wheel")
    assert done.returncode == 0 and "is left out" not in done.stdout


def test_without_catkin_tools_a_line_says_how_to_get_it(tmp_path):
    """Debian's python3 sees no packages of the venv, where the tests have catkin_tools."""
    command = ROOT / "src/workspace_needs/scripts/catkin"
    done = subprocess.run(
        ["/usr/bin/python3", str(command), "build"], text=True, capture_output=True, timeout=60,
        env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(ROOT / "src/workspace_needs/src"),
             "PYTHONNOUSERSITE": "1"})
    if done.returncode != 127:
        pytest.skip("Debian's catkin-tools is installed")
    assert done.stderr.count("\n") == 1 and "apt-get install catkin-tools" in done.stderr
