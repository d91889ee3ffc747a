"""Which roslaunch commands are refused while a simulator runs."""

import socket
from types import SimpleNamespace

import pytest
from workspace_needs.check.parameter_commands import output_of

from bullet_sim_ros import already_running, launch_guard, only_simulator

ROSLAUNCH = ["/usr/bin/python3", "/usr/bin/roslaunch"]
WORLD = '<include file="$(find gazebo_ros)/launch/empty_world.launch"/>'


@pytest.fixture
def refusing(monkeypatch):
    """A master that is online, where /gazebo runs; the names that were asked for."""
    asked = []

    def refusal(_uri, name):
        asked.append(name)
        return ("%s runs", name) if name == "/gazebo" else ()

    monkeypatch.setattr(only_simulator, "refusal", refusal)
    monkeypatch.setattr(launch_guard, "may_simulate", lambda _uri: True)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        uri = f"http://127.0.0.1:{listening.getsockname()[1]}"
        monkeypatch.setenv("ROS_MASTER_URI", uri)
        yield asked


@pytest.fixture
def launch_file(tmp_path):
    def write(text):
        path = tmp_path / "own.launch"
        path.write_text(f"<launch>{text}</launch>")
        return str(path)
    return write


@pytest.mark.parametrize("words", [
    ["learning_topic", "0course.launch"],
    ["learning_topic", "course_follow.launch", "model:=burger"],
    ["turtlebot3_gazebo", "turtlebot3_house.launch"], ["gazebo_ros", "elevator_world.launch"],
    ["--screen", "-v", "gazebo_ros", "empty_world.launch"]])
def test_a_launch_whose_simulator_runs_is_refused(refusing, words):
    assert launch_guard.refusal_of([*ROSLAUNCH, *words]) == "/gazebo runs"


@pytest.mark.parametrize("words", [
    ["--nodes"], ["--files"], ["--dump-params"], ["--ros-args"], ["--args", "gazebo"]])
def test_one_that_only_asks_for_the_files_content_is_not(refusing, words):
    command = [*ROSLAUNCH, *words, "gazebo_ros", "empty_world.launch"]
    assert launch_guard.refusal_of(command) == "" and not refusing


def test_another_namespace_is_another_simulator(refusing, launch_file):
    path = launch_file(f'<group ns="two">{WORLD}</group>')
    assert launch_guard.refusal_of([*ROSLAUNCH, path]) == "" and refusing == ["/two/gazebo"]


def test_a_file_without_a_simulator_and_a_broken_one(refusing, launch_file):
    assert launch_guard.refusal_of(
        [*ROSLAUNCH, launch_file('<node name="x" pkg="rospy_tutorials" type="talker"/>')]) == ""
    assert launch_guard.refusal_of([*ROSLAUNCH, launch_file("<node")]) == ""


def test_other_programs_choose_their_master_later(refusing):
    command = ["/usr/bin/python3", "/usr/bin/rostest", "gazebo_ros", "empty_world.launch"]
    assert launch_guard.refusal_of(command) == "" and not refusing


@pytest.mark.parametrize("words", [["-p", "11399"], ["-p11399"], ["--port=11399"]])
def test_a_port_of_its_own_counts(refusing, monkeypatch, words):
    uris = []
    monkeypatch.setattr(launch_guard, "listens", lambda uri: uri == "http://localhost:11399")
    monkeypatch.setattr(only_simulator, "refusal", lambda uri, _name: uris.append(uri) or ())
    launch_guard.refusal_of([*ROSLAUNCH, *words, "gazebo_ros", "empty_world.launch"])
    assert uris == ["http://localhost:11399"]


@pytest.mark.parametrize("online, clock", [(False, True), (True, False)])
def test_without_a_simulator_at_the_master_no_file_is_read(refusing, monkeypatch, online, clock):
    monkeypatch.setattr(launch_guard, "listens", lambda _uri: online)
    monkeypatch.setattr(launch_guard, "may_simulate", lambda _uri: clock)
    monkeypatch.setattr(launch_guard, "simulators_of", lambda *_: pytest.fail("read"))
    for words in ([], ["-p", "11399"]):
        command = [*ROSLAUNCH, *words, "gazebo_ros", "empty_world.launch"]
        assert launch_guard.refusal_of(command) == ""


@pytest.mark.parametrize(("publishers", "expected"), [
    ([], False), ([["/rosout", ["/follower"]], ["/scan", ["/gazebo_scan"]]], False),
    ([["/clock", ["/player"]]], True), ([["/rosout", ["/two/gazebo"]]], True)])
def test_a_simulator_is_noticed_by_its_clock_or_before_by_its_name(
        monkeypatch, publishers, expected):
    master = SimpleNamespace(getSystemState=lambda _caller: (1, "", (publishers, [], [])))
    monkeypatch.setattr(already_running.xmlrpc.client, "ServerProxy", lambda *_: master)
    assert already_running.may_simulate("http://localhost:11311") is expected


def test_the_value_is_printed_without_a_newline(monkeypatch, capfd):
    monkeypatch.setattr("sys.argv", ["unless_running", "true"])
    monkeypatch.setattr(launch_guard, "_command_line", lambda _: ["python3", "pytest"])
    assert launch_guard.main() == 0
    assert capfd.readouterr() == ("true", "")


def test_check_knows_what_it_prints():
    command = "/somewhere/bullet_sim_ros/scripts/unless_running false"
    assert output_of(command, lambda _: None) == "false"
