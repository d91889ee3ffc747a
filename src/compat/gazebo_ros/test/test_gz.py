"""gz without a simulator: files, and the line for what is not here."""

import subprocess

import pytest
from gazebo_ros.gz import GzError, chosen

ROBOT = """<robot name="cart">
<link name="body"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
iyz="0"/></inertial><visual><geometry><box size="1 2 3"/></geometry></visual></link></robot>"""


def gz(*words, **variables):
    return subprocess.run(["gz", *words], capture_output=True, text=True, timeout=60, check=False,
                          **variables)


def test_a_urdf_file_is_printed_as_sdf_and_checked(tmp_path):
    # conforms: gz/sdf
    (tmp_path / "cart.urdf").write_text(ROBOT, encoding="utf-8")
    printed = gz("sdf", "-p", "cart.urdf", cwd=tmp_path)
    assert printed.stderr == "" and "<size>1 2 3</size>" in printed.stdout
    (tmp_path / "cart.sdf").write_text(printed.stdout, encoding="utf-8")
    checked = gz("sdf", "-k", "cart.sdf", cwd=tmp_path)
    assert (checked.stdout, checked.stderr) == ("Check complete\n", "")
    assert gz("sdf", "-p", "cart.sdf", cwd=tmp_path).stdout == printed.stdout


@pytest.mark.parametrize("text, reason", [
    ("<robot name='r'>", "r.urdf"), ("<robot name='r'/>", "r"), (None, "Unable to find file")])
def test_what_is_no_model_is_one_line(tmp_path, text, reason):
    if text is not None:
        (tmp_path / "r.urdf").write_text(text, encoding="utf-8")
    done = gz("sdf", "-k", "r.urdf", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1)
    assert done.stderr.startswith("gz sdf: ") and reason in done.stderr


WORLD = """<sdf version="1.6"><world name="w"><include><uri>model://{}</uri></include></world>
</sdf>"""


@pytest.mark.parametrize("option", ["-k", "-p"])
def test_models_are_searched_as_by_the_simulator(tmp_path, option):
    (tmp_path / "w.world").write_text(WORLD.format("turtlebot3_autorace/course"))
    for name in ("w.world", "model://turtlebot3_autorace/course", "model://sun"):
        done = gz("sdf", option, name, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "") and done.stdout


@pytest.mark.parametrize("option", ["-k", "-p"])
def test_a_model_that_is_not_there_is_a_failure(tmp_path, option):
    (tmp_path / "w.world").write_text(WORLD.format("nothere"))
    done = gz("sdf", option, "w.world", cwd=tmp_path)
    assert done.returncode == 1 and "Check complete" not in done.stdout
    assert "model://nothere not found" in done.stderr
    assert done.stderr.endswith("gz sdf: w.world has mistakes: 1; each is a line above\n")
    done = gz("sdf", option, "model://nothere", cwd=tmp_path)
    assert done.returncode == 1 and "model://nothere not found" in done.stderr


@pytest.mark.parametrize("steps", ["0", "-1", "two"])
def test_what_is_no_number_of_steps_is_named(steps):
    done = gz("world", "-m", steps)
    assert (done.returncode, done.stdout) == (2, "")
    assert f"{steps} is not a number of steps, 1 or more" in done.stderr


@pytest.mark.parametrize("command", ["camera", "debug", "joint", "log", "marker", "physics",
                                     "stats"])
def test_other_commands_name_what_does_it_here(command):
    done = gz(command, "-h")
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr.startswith(f"gz {command} has no counterpart here. Type: ros")


def test_without_a_simulator_it_says_so(monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:9")
    done = gz("model", "--list")
    assert done.returncode == 1 and "roslaunch gazebo_ros empty_world.launch" in done.stderr


def test_a_master_uri_that_is_none_is_one_line(monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", "http://localhost:1x")
    done = gz("model", "--list")
    assert (done.returncode, done.stderr) == (
        1, "gz model: invalid master URI: http://localhost:1x\n")


@pytest.mark.parametrize("running, own, expected", [
    (["/a/gazebo", "/b/gazebo"], "/b/gazebo", "/b/gazebo"),
    (["/a/gazebo", "/gazebo"], "/gazebo", "/gazebo"),
    (["/a/gazebo"], "/gazebo", "/a/gazebo")])
def test_the_simulator_to_talk_to(running, own, expected):
    assert chosen(running, own, []) == expected


@pytest.mark.parametrize("other", ["/b/gazebo", "/gazebo"])
def test_of_several_simulators_one_is_to_be_named(other):
    with pytest.raises(GzError) as said:
        chosen(["/a/gazebo", other], "/c/gazebo", ["model", "-m", "my car", "-p"])
    assert str(said.value) == (
        f"several simulators run: /a/gazebo, {other}. Name the namespace of one, as in: "
        "ROS_NAMESPACE=a gz model -m 'my car' -p")
