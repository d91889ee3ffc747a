"""The xacro command: its names, $(find …) through rospack, options, exit codes, the PATH hook."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from node_basics.refusing import REFUSED

HERE = Path(__file__).resolve().parents[1]
CORE = HERE.parents[1] / "sim/bullet_sim/src"
ADAPTER = HERE.parents[1] / "sim/bullet_sim_ros/src"
ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="colour" default="red"/>
  <xacro:include filename="$(find wheels)/urdf/wheel.xacro"/>
  <xacro:wheel name="$(arg colour)_wheel"/>
</robot>"""
WHEEL = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="name"><link name="${name}"/></xacro:macro>
</robot>"""
NAMES = ([HERE / "xacro"], [HERE / "xacro.py"], [sys.executable, HERE / "xacro.py"])


@pytest.fixture
def folder(tmp_path):
    """A folder with robot.xacro and a ROS package named wheels."""
    package = tmp_path / "wheels"
    (package / "urdf").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>wheels</name></package>")
    (package / "urdf/wheel.xacro").write_text(WHEEL)
    (tmp_path / "robot.xacro").write_text(ROBOT)
    return tmp_path


def run(folder, *words, command=NAMES[0]):
    environment = os.environ | {
        "ROS_PACKAGE_PATH": str(folder),
        "PYTHONPATH": f"{CORE}{os.pathsep}{ADAPTER}{os.pathsep}{os.environ.get('PYTHONPATH', '')}",
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    }
    return subprocess.run([*command, *words], cwd=folder, env=environment, text=True,
                          encoding="utf-8", capture_output=True, timeout=60)


@pytest.mark.parametrize("command", NAMES)
def test_every_name_finds_packages(folder, command):
    # conforms: xacro command
    result = run(folder, "robot.xacro", command=command)
    assert result.returncode == 0 and result.stderr == ""
    assert '<link name="red_wheel"/>' in result.stdout


@pytest.mark.parametrize("option", ["--inorder", "-i", "--legacy", "--check-order", "-q", "-v"])
def test_accepted_options_change_nothing(folder, option):
    # conforms: xacro command/--inorder, xacro command/NAME:=VALUE
    plain = run(folder, "robot.xacro", "colour:=blue")
    assert run(folder, option, "robot.xacro", "colour:=blue").stdout == plain.stdout
    assert '<link name="blue_wheel"/>' in plain.stdout


def test_output_file_in_a_new_folder(folder):
    # conforms: xacro command/-o
    result = run(folder, "robot.xacro", "-o", "made/robot.urdf")
    assert (result.returncode, result.stdout) == (0, "")
    assert "red_wheel" in (folder / "made/robot.urdf").read_text()


def test_dependencies(folder):
    # conforms: xacro command/--deps
    assert run(folder, "--deps", "robot.xacro").stdout == f"{folder}/wheels/urdf/wheel.xacro\n"


def test_text_beyond_ascii_in_any_locale(folder):
    (folder / "robot.xacro").write_text('<robot><link name="轮子"/></robot>', encoding="utf-8")
    command = ["env", "LC_ALL=C", "PYTHONIOENCODING=ascii", *NAMES[0]]
    assert "轮子" in run(folder, "robot.xacro", command=command).stdout


def test_quiet_hides_the_warning(folder):
    (folder / "robot.xacro").write_text("<robot><wheel/></robot>")
    assert "<wheel>" in run(folder, "robot.xacro").stderr
    assert run(folder, "-q", "robot.xacro").stderr == ""


@pytest.mark.parametrize(("inside", "said"), [
    ("$(find nowhere)", "no package nowhere below"),
    ("${width}", "property 'width' is not defined"),
    ("$(arg size)", "size:=VALUE"),
])
def test_a_mistake_is_one_line_and_exit_code_2(folder, inside, said):
    # conforms: xacro command/exit code 2
    (folder / "robot.xacro").write_text(f'<robot><link name="{inside}"/></robot>')
    result = run(folder, "robot.xacro")
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr.startswith("xacro: error: robot.xacro: ") and said in result.stderr
    assert result.stderr.count("\n") == 1


def test_an_expression_that_takes_all_memory_is_one_line(folder):
    (folder / "robot.xacro").write_text('<robot><link name="${len(str(1) * 10 ** 10)}"/></robot>')
    result = run(folder, "robot.xacro")
    assert result.returncode == 2 and "needs more memory than there is" in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize("words", [[], ["none.xacro"], ["a", "b"], ["robot.xacro", "a:=b:=c"]])
def test_wrong_use_is_exit_code_2(folder, words):
    result = run(folder, *words)
    assert result.returncode == 2 and "error" in result.stderr


def test_an_unknown_turtlebot3_is_answered_with_those_there_are(folder):
    for name in ("burger", "waffle", "waffle_pi", "burger_for_autorace"):
        (folder / f"turtlebot3_{name}.urdf.xacro").write_text("<robot name='r'/>")
    result = run(folder, "turtlebot3_wafle.urdf.xacro")
    assert result.returncode == REFUSED
    assert result.stderr.count("\n") == 1
    assert ("is wafle: no such model; there are: burger, waffle, waffle_pi\n" in result.stderr
            and "did you mean turtlebot3_waffle.urdf.xacro?" in result.stderr)


def test_somebodys_own_file_named_like_a_turtlebot3_is_no_model_of_it(folder):
    assert run(folder, "turtlebot3_mine.urdf.xacro").stderr == (
        "xacro: error: turtlebot3_mine.urdf.xacro does not exist\n")


def test_a_package_of_a_workspace_that_is_not_sourced(folder, tmp_path_factory, monkeypatch):
    home = tmp_path_factory.mktemp("home")
    built = home / "my_ws"
    (built / "src/legs").mkdir(parents=True)
    (built / "src/legs/package.xml").touch()
    (built / "devel").mkdir()
    (built / "devel/setup.bash").touch()
    (folder / "robot.xacro").write_text(ROBOT.replace("find wheels", "find legs"))
    assert "is its workspace sourced?" in run(folder, "robot.xacro").stderr
    monkeypatch.setenv("HOME", str(home))
    assert (f"its workspace is not sourced: source {built}/devel/setup.bash"
            in run(folder, "robot.xacro").stderr)
