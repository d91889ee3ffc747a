"""What the scripts do with a learner's packages, in our src/ or in a workspace of their own."""

import importlib.util
import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
SETUP_PYTHON = "/usr/bin/python3"  # setup runs its scripts by it, before there is another
HOOK = ROOT / "src/sim/bullet_sim_ros/env-hooks/50.bullet_sim_ros.sh"
PACKAGE = """<?xml version="1.0"?>
<package format="2">
  <name>{}</name>
  <version>0.1.0</version>
  <description>A package.</description>
  <maintainer email="learner@example.org">learner</maintainer>
  <license>BSD</license>
</package>
"""


BUILD_CAUSE = ROOT / "src/workspace_needs/src/workspace_needs/build_cause.py"


def load(path: Path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def src(tmp_path):
    """A src/ with two packages of ours."""
    make_package(tmp_path / "src/compat/turtlesim")
    make_package(tmp_path / "src/learning_topic")
    return tmp_path / "src"


def make_package(folder: Path, name: str | None = None) -> None:
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(PACKAGE.format(name or folder.name))


def arrange(src: Path) -> subprocess.CompletedProcess:
    return subprocess.run([SETUP_PYTHON, ROOT / "scripts/own_packages.py", src], text=True,
                          capture_output=True, cwd=src)


def markers(src: Path) -> list[str]:
    return sorted(str(path.parent.relative_to(src)) for path in src.rglob("CATKIN_IGNORE"))


def test_nothing_is_said_where_all_packages_are_ours(src):
    done = arrange(src)
    assert (done.returncode, done.stdout, done.stderr, markers(src)) == (0, "", "", [])


def test_a_package_of_the_same_name_takes_the_place_of_ours_and_gives_it_back(src):
    make_package(src / "somebody/turtlesim_folder", "turtlesim")
    done = arrange(src)
    assert done.stdout == "Built in place of ours: turtlesim (src/somebody/turtlesim_folder)\n"
    assert markers(src) == ["compat/turtlesim"]
    assert arrange(src).stdout == done.stdout
    (src / "somebody/turtlesim_folder/package.xml").unlink()
    done = arrange(src)
    assert (done.stdout, markers(src)) == ("Ours again: turtlesim\n", [])


def test_a_clone_of_gazebos_own_package_is_left_out_and_ours_stays(src):
    make_package(src / "gazebo_ros_pkgs/gazebo_ros")
    done = arrange(src)
    assert (done.returncode, markers(src)) == (0, ["gazebo_ros_pkgs/gazebo_ros"])


def test_a_marker_that_a_person_made_stays(src):
    (src / "compat/CATKIN_IGNORE").touch()
    make_package(src / "somebody/turtlesim")
    assert arrange(src).stdout == ""
    assert markers(src) == ["compat"]


def test_two_packages_of_the_learners_with_one_name_are_an_error_that_names_both(src):
    make_package(src / "a/turtlesim")
    make_package(src / "b/turtlesim")
    done = arrange(src)
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "src/a/turtlesim and src/b/turtlesim" in done.stderr


def test_every_package_of_this_repository_lies_in_one_of_our_folders():
    own = load_with_system_python()
    listed = subprocess.run(["git", "ls-files", "src/**/package.xml"], cwd=ROOT, text=True,
                            capture_output=True).stdout.split()
    assert {path.split("/")[1] for path in listed} <= own


def load_with_system_python() -> set[str]:
    text = (ROOT / "scripts/own_packages.py").read_text()
    folders = re.search(r"OUR_FOLDERS = \(([^)]*)\)", text).group(1)
    return set(re.findall(r'"(\w+)"', folders))


CAUSES = {
    "cmake": ("""-- before
-- Could not find the required component 'foo_msgs'. The following CMake error indicates
CMake Error at /usr/share/catkin/cmake/catkinConfig.cmake:82 (find_package):
  Could not find a package configuration file provided by "foo_msgs" with any
  of the following names:

    foo_msgsConfig.cmake
Call Stack (most recent call first):
  a/CMakeLists.txt:3 (find_package)
""", ["catkinConfig.cmake:82", 'provided by "foo_msgs"', "`make deps`"]),
    "cmake, wrapped before the name": ("""CMake Error at a/CMakeLists.txt:3 (find_package):
  Could not find a package configuration file provided by
  "camera_info_manager" with any of the following names:
""", ["CMakeLists.txt:3", "camera_info_manager is not installed: `make deps`"]),
    "compiler": ("""[ 10%] Building CXX object a.cpp.o
/ws/src/a/a.cpp:3:10: fatal error: nowhere.h: No such file or directory
    3 | #include <nowhere.h>
      |          ^~~~~~~~~~~
compilation terminated.
make[2]: *** [a.make:76: a.cpp.o] Error 1
""", ["a.cpp:3:10: fatal error: nowhere.h", "#include <nowhere.h>"]),
    "linker": ("""/usr/bin/ld: a.o: in function `main':
a.cpp:(.text+0x5): undefined reference to `missing()'
collect2: error: ld returned 1 exit status
""", ["undefined reference to `missing()'"]),
    "package.xml": ("""Error(s) in package '/ws/src/a/package.xml':
Invalid email "nobody" for person "x"
""", ["package.xml", "Invalid email"]),
    "front": ("""Base path: /ws
catkin_make: src/a/package.xml: Invalid email "x" for person "y"; mend it first
""", ["src/a/package.xml: Invalid email"]),
    "setup.py": ("""Traceback (most recent call last):
  File "/usr/share/catkin/cmake/interrogate_setup_dot_py.py", line 1, in <module>
  File "/ws/src/a/setup.py", line 2, in <module>
NameError: name 'x' is not defined
CMake Error at /usr/share/catkin/cmake/safe_execute_process.cmake:11 (message):
""", ["setup.py", "NameError"]),
}


@pytest.mark.parametrize("kind", CAUSES)
def test_a_failed_build_shows_its_first_cause(kind, tmp_path):
    text, wanted = CAUSES[kind]
    (tmp_path / "build.log").write_text(text)
    done = subprocess.run([SETUP_PYTHON, BUILD_CAUSE, tmp_path / "build.log"],
                          text=True, capture_output=True)
    for said in wanted:
        assert said in done.stdout
    assert done.stdout.count("\n") <= 7


def test_a_build_that_went_well_has_no_cause():
    assert load(BUILD_CAUSE).cause("-- ok\n[100%] Built target a\n") == []


@pytest.mark.parametrize(("path", "expected"), [
    ("/usr/bin:/bin", "{venv}:/usr/bin:/bin"),
    ("{devel}/bin:/usr/bin", "{devel}/bin:{venv}:/usr/bin"),
    ("/top/bin:{devel}/bin:/usr/bin", "/top/bin:{devel}/bin:{venv}:/usr/bin"),
    ("{venv}:/top/bin:{devel}/bin:/usr/bin:{venv}", "/top/bin:{devel}/bin:{venv}:/usr/bin"),
])
def test_programs_of_a_workspace_on_top_come_before_ours(tmp_path, path, expected):
    devel, venv = tmp_path / "a b/devel", tmp_path / "a b/.venv/bin"
    venv.mkdir(parents=True)
    (venv / "python3").symlink_to("/usr/bin/python3")
    fill = {"devel": devel, "venv": venv}
    done = subprocess.run(["/bin/sh", "-euc", f'. "{HOOK}"; . "{HOOK}"; echo "$PATH"'], text=True,
                          capture_output=True, check=True,
                          env={"PATH": path.format(**fill),
                               "CATKIN_ENV_HOOK_WORKSPACE": str(devel)})
    assert done.stdout == expected.format(**fill) + "\n"


def test_check_and_cmake_know_the_same_missing_headers():
    text = (ROOT / "src/interfaces/missing_headers/cmake/missing_headers.cmake").read_text()
    of_cmake = {word for words in re.findall(r"set\(_missing_headers_\w+\s([^)]*)\)", text)
                for word in words.split()}
    rows = yaml.safe_load((ROOT / "src/workspace_needs/data/absent.yaml").read_text())
    assert of_cmake == {header for row in rows for header in row.get("headers", ())}


def deps(*words: str) -> subprocess.CompletedProcess:
    return subprocess.run([ROOT / "scripts/deps.sh", "--simulate", *words], text=True,
                          capture_output=True, cwd="/")


def test_deps_names_what_is_wrong_with_the_workspace(tmp_path):
    done = deps(str(tmp_path / "catkin_w"))
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1 and "there is no such folder" in done.stderr


def test_deps_reads_the_workspace_that_it_is_given():
    done = deps(str(ROOT / "test/workspaces/shapes"))
    assert done.returncode == 0 and done.stdout.startswith("16 packages"), done.stdout + done.stderr
    assert "shape_gazebo: include/shape_gazebo/plugin.h is left out" in done.stdout
    assert done.stderr == ""


def test_the_table_of_packages_is_what_its_files_say():
    if not subprocess.run(["apt-cache", "show", "libroscpp-dev"], capture_output=True).stdout:
        pytest.skip("apt has no lists here")
    done = subprocess.run([SETUP_PYTHON, ROOT / "scripts/workspace_table.py", "--check"],
                          text=True, capture_output=True, timeout=60)
    assert done.returncode == 0, done.stderr
