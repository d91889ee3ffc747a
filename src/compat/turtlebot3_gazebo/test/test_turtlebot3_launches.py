"""Every launch file of TurtleBot3's packages: it parses, its nodes, arguments and files exist."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import roslaunch.config
import roslaunch.xmlloader

COMPAT = Path(__file__).resolve().parents[2]
PACKAGES = ("turtlebot3_gazebo", "turtlebot3_bringup", "turtlebot3_fake")
FILES = sorted(path for package in PACKAGES for path in (COMPAT / package).glob("launch/*.launch"))
WORLDS = {  # launch: world, x, y, name of what is spawned (with TURTLEBOT3_MODEL burger)
    "turtlebot3_empty_world": ("empty", "0.0", "0.0", "turtlebot3_burger"),
    "turtlebot3_world": ("turtlebot3_world", "-2.0", "-0.5", "turtlebot3_burger"),
    "turtlebot3_house": ("turtlebot3_house", "-3.0", "1.0", "turtlebot3"),
    "turtlebot3_stage_1": ("turtlebot3_stage_1", "0.0", "0.0", "turtlebot3_burger"),
    "turtlebot3_stage_2": ("turtlebot3_stage_2", "0.0", "0.0", "turtlebot3_burger"),
    "turtlebot3_stage_3": ("turtlebot3_stage_3", "0.0", "0.0", "turtlebot3_burger"),
    "turtlebot3_stage_4": ("turtlebot3_stage_4", "-0.7", "0.0", "turtlebot3_burger"),
    "turtlebot3_autorace": ("turtlebot3_autorace", "0.245", "-1.787", "turtlebot3_burger"),
    "turtlebot3_autorace_2020": ("turtlebot3_autorace_2020", "0.8", "-1.747", "autorace"),
}
REAL = ("robot", "core", "lidar", "rpicamera", "realsense")


def load(path, *arguments, commands=None):
    """The launch file as roslaunch has it; robots' commands are not run, but kept in `commands`."""
    config = roslaunch.config.ROSLaunchConfig()
    loader = roslaunch.xmlloader.XmlLoader()
    written = loader.param_value

    def value(*given):
        if given[-1] is None or "/unless_running " in given[-1]:  # it prints its arguments
            return written(*given)
        if commands is not None:
            commands.append(given[-1])
        return "a robot"

    loader.param_value = value
    os.environ["TURTLEBOT3_MODEL"] = "burger"
    loader.load(str(path), config, argv=list(arguments), verbose=False)
    return config


def launch(name):
    (found,) = (path for path in FILES if path.stem == name)
    return found


def nodes(config):
    return {f"{node.namespace}{node.name}": node for node in config.nodes}


def values(config):
    return {name: parameter.value for name, parameter in config.params.items()}


@pytest.fixture(autouse=True)
def restored_environment(monkeypatch):
    monkeypatch.setenv("TURTLEBOT3_MODEL", "waffle")


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_it_parses_and_what_it_names_exists(path):
    config = load(path)
    assert config.nodes
    for node in config.nodes:
        words = [word for word in node.args.split() if word.startswith("/") and "." in word]
        assert all(Path(word).is_file() for word in words), node.args


@pytest.mark.parametrize("name", WORLDS)
def test_world_launch(name):
    # conforms: turtlebot3_empty_world.launch, turtlebot3_empty_world.launch/model
    # conforms: turtlebot3_empty_world.launch/x_pos, turtlebot3_empty_world.launch/y_pos
    # conforms: turtlebot3_empty_world.launch/z_pos, turtlebot3_world.launch
    # conforms: turtlebot3_world.launch/model, turtlebot3_world.launch/x_pos
    # conforms: turtlebot3_world.launch/y_pos, turtlebot3_world.launch/z_pos
    # conforms: turtlebot3_house.launch, turtlebot3_house.launch/model
    # conforms: turtlebot3_house.launch/x_pos, turtlebot3_house.launch/y_pos
    # conforms: turtlebot3_house.launch/z_pos, turtlebot3_stage_1.launch
    # conforms: turtlebot3_stage_1.launch/model, turtlebot3_stage_1.launch/x_pos
    # conforms: turtlebot3_stage_1.launch/y_pos, turtlebot3_stage_1.launch/z_pos
    # conforms: turtlebot3_stage_2.launch, turtlebot3_stage_2.launch/model
    # conforms: turtlebot3_stage_2.launch/x_pos, turtlebot3_stage_2.launch/y_pos
    # conforms: turtlebot3_stage_2.launch/z_pos, turtlebot3_stage_3.launch
    # conforms: turtlebot3_stage_3.launch/model, turtlebot3_stage_3.launch/x_pos
    # conforms: turtlebot3_stage_3.launch/y_pos, turtlebot3_stage_3.launch/z_pos
    # conforms: turtlebot3_stage_4.launch, turtlebot3_stage_4.launch/model
    # conforms: turtlebot3_stage_4.launch/x_pos, turtlebot3_stage_4.launch/y_pos
    # conforms: turtlebot3_stage_4.launch/z_pos, turtlebot3_autorace.launch
    # conforms: turtlebot3_autorace.launch/x_pos, turtlebot3_autorace.launch/y_pos
    # conforms: turtlebot3_autorace.launch/z_pos, turtlebot3_autorace_2020.launch
    # conforms: turtlebot3_autorace_2020.launch/x_pos, turtlebot3_autorace_2020.launch/y_pos
    # conforms: turtlebot3_autorace_2020.launch/z_pos
    world, x, y, model = WORLDS[name]
    config = load(launch(name))
    found = nodes(config)
    assert f"/worlds/{world}.world" in found["/gazebo"].args
    place = f"-urdf -model {model} -x {x} -y {y} -z 0.0 -param robot_description"
    assert found["/spawn_urdf"].args == place
    assert values(config)["/use_sim_time"] is True
    moved = nodes(load(launch(name), "x_pos:=1.5", "y_pos:=2.5", "z_pos:=0.5"))["/spawn_urdf"]
    assert "-x 1.5 -y 2.5 -z 0.5" in moved.args
    if "autorace" not in name:
        commands = []
        load(launch(name), "model:=waffle_pi", commands=commands)
        assert "/urdf/turtlebot3_waffle_pi.urdf.xacro" in commands[0]


def test_multi_turtlebot3():
    # conforms: multi_turtlebot3.launch, multi_turtlebot3.launch/model
    # conforms: multi_turtlebot3.launch/first_tb3, multi_turtlebot3.launch/first_tb3_x_pos
    # conforms: multi_turtlebot3.launch/first_tb3_y_pos
    # conforms: multi_turtlebot3.launch/first_tb3_z_pos
    # conforms: multi_turtlebot3.launch/first_tb3_yaw
    config = load(launch("multi_turtlebot3"))
    found, parameters = nodes(config), values(config)
    assert "turtlebot3_house.world" in found["/gazebo"].args
    starts = {"tb3_0": ("-7.0", "-1.0", "1.57"), "tb3_1": ("7.0", "-1.0", "1.57"),
              "tb3_2": ("0.5", "3.0", "0.0")}
    for robot, (x, y, yaw) in starts.items():
        place = f"-urdf -model {robot} -x {x} -y {y} -z 0.0 -Y {yaw} -param robot_description"
        assert found[f"/{robot}/spawn_urdf"].args == place
        assert parameters[f"/{robot}/robot_state_publisher/tf_prefix"] == robot
        assert parameters[f"/{robot}/tf_prefix"] == robot
        assert parameters[f"/{robot}/robot_state_publisher/publish_frequency"] == 50.0
        assert parameters[f"/{robot}/robot_description"] == "a robot"
    commands = []
    other = load(launch("multi_turtlebot3"), "first_tb3:=anna", "first_tb3_x_pos:=1",
                 "first_tb3_y_pos:=2", "first_tb3_z_pos:=3", "first_tb3_yaw:=0.5",
                 "model:=waffle_pi", commands=commands)
    assert "-model anna -x 1 -y 2 -z 3 -Y 0.5 " in nodes(other)["/anna/spawn_urdf"].args
    assert len(commands) == 3 and all("waffle_pi" in command for command in commands)


def test_slam_of_several_robots():
    # conforms: multi_turtlebot3_slam.launch, multi_turtlebot3_slam.launch/ns
    # conforms: multi_map_merge.launch, turtlebot3_autorace_mission.launch
    config = load(launch("multi_turtlebot3_slam"), "ns:=tb3_2")
    frames = {name: values(config)[f"/tb3_2/tb3_2_gmapping/{name}"]
              for name in ("base_frame", "odom_frame", "map_frame")}
    assert frames == {"base_frame": "tb3_2/base_footprint", "odom_frame": "tb3_2/odom",
                      "map_frame": "tb3_2/map"}
    assert nodes(load(launch("multi_map_merge")))["/map_merge"].package == "multirobot_map_merge"
    mission = nodes(load(launch("turtlebot3_autorace_mission")))["/mission_control"]
    assert (mission.package, mission.type) == ("turtlebot3_autorace_core", "core_node_mission")


def test_remote_model_and_rviz(monkeypatch):
    # conforms: turtlebot3_remote.launch, turtlebot3_remote.launch/model
    # conforms: turtlebot3_remote.launch/multi_robot_name, turtlebot3_model.launch
    # conforms: turtlebot3_model.launch/model, turtlebot3_model.launch/multi_robot_name
    # conforms: turtlebot3_gazebo_rviz.launch, turtlebot3_gazebo_rviz.launch/model
    # conforms: turtlebot3_fake.launch/model
    remote = load(launch("turtlebot3_remote"), "multi_robot_name:=tb3_7")
    assert values(remote)["/robot_state_publisher/tf_prefix"] == "tb3_7"
    assert values(remote)["/robot_state_publisher/publish_frequency"] == 50.0
    assert values(remote)["/robot_description"] == "a robot"
    model = load(launch("turtlebot3_model"))
    assert values(model)["/joint_state_publisher/use_gui"] is True
    assert values(model)["/joint_state_publisher/rate"] == 50.0
    monkeypatch.setenv("DISPLAY", ":0")
    for name in ("turtlebot3_model", "turtlebot3_gazebo_rviz", "turtlebot3_fake"):
        found = nodes(load(launch(name)))
        assert found["/rviz"].args.startswith("-d /") and "/robot_state_publisher" in found
    for name in ("remote", "model", "gazebo_rviz", "fake"):
        commands = []
        load(launch(f"turtlebot3_{name}"), "model:=waffle_pi", commands=commands)
        assert "turtlebot3_waffle_pi.urdf.xacro" in commands[0]
    prefixed = load(launch("turtlebot3_model"), "multi_robot_name:=tb3_7")
    assert values(prefixed)["/robot_state_publisher/tf_prefix"] == "tb3_7"


@pytest.mark.parametrize("name", ["turtlebot3_model", "turtlebot3_gazebo_rviz"])
def test_without_a_screen_one_line_stands_for_rviz(name, monkeypatch):
    """These have no open_rviz, and so none is advised."""
    monkeypatch.delenv("DISPLAY", raising=False)
    line = nodes(load(launch(name)))["/rviz"]
    assert (line.package, line.required) == ("turtlebot3_bringup", False)
    program = COMPAT / "turtlebot3_bringup" / "nodes" / line.type
    done = subprocess.run([sys.executable, program, *line.args.split()], capture_output=True,
                          text=True, check=True)
    assert len(done.stderr.splitlines()) == 1 and "DISPLAY is not set" in done.stderr
    assert "open_rviz" not in done.stderr


def test_simulation_and_fake():
    # conforms: turtlebot3_simulation.launch, turtlebot3_simulation.launch/cmd_vel
    # conforms: turtlebot3_simulation.launch/name, turtlebot3_fake.launch
    config = load(launch("turtlebot3_simulation"), "cmd_vel:=/a/cmd_vel", "name:=anna")
    node = nodes(config)["/anna_drive"]
    assert (node.type, node.required) == ("turtlebot3_drive", True)
    assert values(config)["/cmd_vel_topic_name"] == "/a/cmd_vel"
    fake = load(launch("turtlebot3_fake"), "model:=waffle_pi")
    assert values(fake)["/tb3_model"] == "waffle_pi"
    assert nodes(fake)["/turtlebot3_fake_node"].type == "turtlebot3_fake_node"


@pytest.mark.parametrize("part", REAL)
def test_a_real_robot_is_a_clear_message(part):
    # conforms: turtlebot3_robot.launch
    (node,) = load(launch(f"turtlebot3_{part}")).nodes
    assert node.required
    program = COMPAT / "turtlebot3_bringup" / "nodes" / node.type
    done = subprocess.run([sys.executable, program, *node.args.split()], capture_output=True,
                          text=True, check=False)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1
    assert f"turtlebot3_{part}.launch starts the motors and sensors" in done.stderr
    assert "roslaunch turtlebot3_gazebo turtlebot3_world.launch" in done.stderr


@pytest.mark.parametrize("file", ["turtlebot3_world.launch", "somebodys.launch"])
@pytest.mark.parametrize("language, said", [("en", "no such model"), ("zh_CN", "没有这个型号")])
def test_an_unknown_model_ends_with_one_line(tmp_path, file, language, said):
    (tmp_path / "somebodys.launch").write_text("""<launch>
      <param name="robot" command="$(find xacro)/xacro.py
        $(find turtlebot3_description)/urdf/turtlebot3_$(env TURTLEBOT3_MODEL).urdf.xacro"/>
    </launch>""")
    where = [tmp_path / file] if file == "somebodys.launch" else ["turtlebot3_gazebo", file]
    typed = os.environ | {"TURTLEBOT3_MODEL": "wafle", "LC_ALL": "C.UTF-8", "LANGUAGE": language}
    done = subprocess.run(["roslaunch", "--nodes", *where], env=typed, text=True, timeout=60,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode == 1 and done.stdout.count("\n") == 1, done.stdout
    assert said in done.stdout and done.stdout.endswith("burger, waffle, waffle_pi\n")
