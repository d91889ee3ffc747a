"""The command line of spawner, and the lines that name the cause of a failure."""

import socket
from types import SimpleNamespace

import pytest
from controller_manager import client, configuration, diagnosis, spawning
from controller_manager_msgs.msg import ControllerState, HardwareInterfaceResources
from node_basics import running


def listed(*rows):
    """Controllers from (name, state, joint)."""
    return [ControllerState(name, state, "t/T", [HardwareInterfaceResources("i", [joint])])
            for name, state, joint in rows]


def test_no_yaml_file_was_loaded():
    line = diagnosis.not_configured("left", "/racecar", ["/use_sim_time", "/racecar/type"])
    assert line == ("parameter /racecar/left/type is not set, nor is any controller's in /racecar: "
                    'load the YAML file, <rosparam command="load" file="..." ns="/racecar"/>')


def test_loaded_into_another_namespace():
    line = diagnosis.not_configured("left", "/racecar", ["/left/type", "/racecar/right/type"])
    assert "parameter /racecar/left/type is not set, but /left/type is: " in line


def test_the_namespace_is_in_the_name_once_more():
    for namespace, name, there in (
            ("/arm", "arm/j1", "/arm/j1"), ("/arm", "/arm/j1", "/arm/j1"),
            ("/lab/arm", "arm/j1", "/lab/arm/j1"), ("/lab/arm", "lab/arm/j1", "/lab/arm/j1")):
        line = diagnosis.not_configured(name, namespace, [f"{there}/type", f"{there}/pid/p"])
        assert line.startswith(f"{name} is looked for in {namespace}, as {namespace}/")
        assert line.endswith(": write j1")


def test_a_controller_with_a_slash_in_its_name():
    line = diagnosis.not_configured("lab/arm/j1", "/lab", ["/lab/arm/j1/type"])
    assert line.endswith(": write arm/j1")


def test_a_mistyped_name():
    parameters = ["/left_wheel/type", "/arm/type", "/left_wheel/pid/type"]
    line = diagnosis.not_configured("left_whel", "/", parameters)
    assert line == ("parameter /left_whel/type is not set; in / there are: arm, left_wheel; "
                    "is left_wheel meant?")


def test_a_mistyped_name_with_a_slash():
    for name in ("arm/j2", "/arm/j2"):
        line = diagnosis.not_configured(name, "/lab", ["/lab/arm/j1/type", "/lab/x/type"])
        assert line.endswith("in /lab there are: arm/j1; is arm/j1 meant?")
    line = diagnosis.not_configured("arm/j2", "/arm", ["/arm/j1/type"])
    assert line == "parameter /arm/arm/j2/type is not set; in /arm there are: j1"


def test_a_namespace_instead_of_a_controller():
    line = diagnosis.not_configured("racecar", "/", ["/racecar/left/type", "/racecar/right/type"])
    assert line == ("racecar is a namespace with the controllers left, right: "
                    "spawn these with --namespace=/racecar")


def test_unknown_type():
    types = ["effort_controllers/JointPositionController", "diff_drive_controller/DiffDrive"]
    assert diagnosis.unknown_type("effort_controllers/JointPosController", types) == (
        "there is no controller type effort_controllers/JointPosController; "
        "is effort_controllers/JointPositionController meant?")
    assert diagnosis.unknown_type("x", types).endswith("list-types` shows those there are")


def test_switches():
    controllers = listed(("a", "running", "elbow"), ("b", "initialized", "elbow"),
                         ("c", "stopped", "wrist"))
    for start, stop, cause in (
            (["d"], [], "not loaded: d (loaded: a, b, c)"),
            (["a"], [], "running already: a"),
            ([], ["b"], "not running: b"),
            (["b"], [], "joint elbow is claimed by a and b"),
            (["b"], ["a"], diagnosis.SEE_LOG),
            (["c"], [], diagnosis.SEE_LOG)):
        assert diagnosis.switch_failure(controllers, start, stop) == cause


def test_a_killed_manager_or_simulator_does_not_count(monkeypatch):
    names = ("/car/controller_manager/list_controllers", "/gazebo/spawn_urdf_model")
    with socket.socket() as dead:
        dead.bind(("localhost", 0))
        monkeypatch.setattr(running.rosgraph, "Master", lambda _: SimpleNamespace(
            getSystemState=lambda: ([], [], [[name, ["n"]] for name in names]),
            lookupNode=lambda _: f"http://localhost:{dead.getsockname()[1]}/"))
        assert "is the simulator running" in client.ManagerClient("car").absence("load_controller")


def test_no_manager():
    service = "/car/controller_manager/load_controller"
    assert "A controller manager answers in: /arm, /racecar " in client.absence(
        service, ["/arm", "/racecar"], ["/gazebo"])
    assert "no controller manager in any namespace" in client.absence(service, [], [])
    assert ("namespace. A simulator runs as: /x/y/gazebo, /z/gazebo. Has the robot come into its "
            "world (rosservice call /x/y/gazebo/get_world_properties)") in client.absence(
        service, [], ["/x/y/gazebo", "/z/gazebo"])
    assert client.absence(service, ["/car"], []).endswith(
        " yet: the controller manager in /car is starting")


def test_upstreams_options():
    options = spawning.arguments().parse_args(["--namespace=/rrbot", "a", "b"])
    assert (options.namespace, options.controllers, options.timeout) == ("/rrbot", ["a", "b"], 30)
    assert (options.stopped, options.wait_for, options.no_timeout, options.shutdown_timeout) \
        == (False, None, False, None)
    options = spawning.arguments().parse_args(
        "--stopped --wait-for go --timeout 0 --no-timeout --shutdown-timeout 3 a".split())
    assert (options.stopped, options.wait_for, options.timeout, options.no_timeout) \
        == (True, "go", 0.0, True)


def test_a_controller_is_needed(capsys):
    with pytest.raises(SystemExit) as ended:
        spawning.arguments().parse_args([])
    assert ended.value.code == 2
    assert "controller" in capsys.readouterr().err


def test_what_is_a_file(tmp_path):
    (tmp_path / "arm").write_text("")
    assert configuration.is_file_name(str(tmp_path / "arm"))
    assert configuration.is_file_name("none.yaml")
    assert not configuration.is_file_name("joint_state_controller")
