"""Packages and nodes that robots of older releases name: rospack and catkin find them."""

import os
import signal
import socket
import subprocess
import time
from pathlib import Path

import pytest
import rospkg
from roslib.packages import find_node

NAMES = (
    "gazebo_ros", "gazebo_msgs", "gazebo_plugins", "gazebo_ros_control", "gazebo_dev",
    "gazebo_ros_pkgs", "controller_manager", "controller_manager_msgs", "ros_control",
    "ros_controllers", "joint_state_controller", "effort_controllers", "position_controllers",
    "velocity_controllers", "diff_drive_controller", "joint_trajectory_controller", "xacro")

ROBOT = """<launch>
  <param name="robot_description"
         value="&lt;robot name='one'&gt;&lt;link name='a'/&gt;&lt;/robot&gt;"/>
  <node name="robot_state_publisher" pkg="robot_state_publisher" type="robot_state_publisher"
        respawn="true" output="screen"/>
</launch>"""


@pytest.mark.parametrize("name", NAMES)
def test_a_robots_package_can_depend_on_it(name):
    # conforms: find_package(catkin COMPONENTS)/gazebo_ros
    # conforms: find_package(catkin COMPONENTS)/gazebo_msgs
    # conforms: find_package(catkin COMPONENTS)/gazebo_plugins
    # conforms: find_package(catkin COMPONENTS)/gazebo_ros_control
    # conforms: find_package(catkin COMPONENTS)/gazebo_dev
    # conforms: find_package(catkin COMPONENTS)/gazebo_ros_pkgs
    # conforms: find_package(catkin COMPONENTS)/controller_manager
    # conforms: find_package(catkin COMPONENTS)/controller_manager_msgs
    # conforms: find_package(catkin COMPONENTS)/ros_control
    # conforms: find_package(catkin COMPONENTS)/ros_controllers
    # conforms: find_package(catkin COMPONENTS)/joint_state_controller
    # conforms: find_package(catkin COMPONENTS)/effort_controllers
    # conforms: find_package(catkin COMPONENTS)/position_controllers
    # conforms: find_package(catkin COMPONENTS)/velocity_controllers
    # conforms: find_package(catkin COMPONENTS)/diff_drive_controller
    # conforms: find_package(catkin COMPONENTS)/joint_trajectory_controller
    # conforms: find_package(catkin COMPONENTS)/xacro
    assert Path(rospkg.RosPack().get_path(name)).is_dir()
    prefixes = os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep)
    assert any((Path(prefix) / "share" / name / "cmake" / f"{name}Config.cmake").is_file()
               for prefix in prefixes)


@pytest.mark.parametrize("name", ["state_publisher", "robot_state_publisher"])
def test_robot_state_publisher_starts_by_both_its_names(name):
    (node,) = find_node("robot_state_publisher", name)
    nowhere = {**os.environ, "ROS_MASTER_URI": "no address"}
    ended = subprocess.run([node], env=nowhere, capture_output=True, text=True, timeout=60,
                           check=False)
    assert "master URI [no address]" in ended.stderr  # it is roscpp that complains
    assert ("deprecated" in ended.stderr) == (name == "state_publisher")


def test_a_second_robot_state_publisher_waits_and_the_first_notices_nothing(tmp_path):
    # course, then `roslaunch turtlebot3_gazebo turtlebot3_gazebo_rviz.launch`: roscpp ends both
    robot = tmp_path / "robot.launch"
    robot.write_text(ROBOT)
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = str(free.getsockname()[1])
    there = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}"}
    started = []

    def start(*command):
        log = tmp_path / f"log{len(started)}"
        with log.open("w") as file:
            started.append(subprocess.Popen(command, env=there, stdout=file, stderr=file))
        return log

    def wait_until(condition):
        until = time.monotonic() + 60
        while not condition():
            assert time.monotonic() < until
            time.sleep(0.2)

    start("roscore", "-p", port)
    try:
        wait_until(lambda: "/rosout" in nodes(there))
        first = start("roslaunch", robot)
        wait_until(lambda: "/robot_state_publisher" in nodes(there))
        second = start("roslaunch", robot)
        line = "robot_state_publisher runs already on this master (/robot_state_publisher)"
        wait_until(lambda: line in second.read_text())
        assert "/robot_state_publisher" in nodes(there)
        started[1].send_signal(signal.SIGINT)
        started[1].wait(60)
        wait_until(lambda: "/robot_state_publisher" in nodes(there))  # the second
        assert second.read_text().count(line) == 1
    finally:
        for program in reversed(started):
            program.send_signal(signal.SIGINT)
            program.wait(60)
    assert "Shutdown request" not in first.read_text() + second.read_text()


def nodes(environment):
    return subprocess.run(["rosnode", "list"], env=environment, capture_output=True, text=True,
                          timeout=60, check=False).stdout.split()
