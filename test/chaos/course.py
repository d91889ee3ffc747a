"""The course of a round, and how its processes are recognised."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ByHand:
    """The commands that are typed into terminals instead."""

    world: tuple[str, ...]  # after roslaunch: package, file, arguments
    commands: dict[str, tuple[str, ...]]  # after rosrun, for each driver


SIZE = ("camera_width:=320", "camera_height:=240")  # px, as in a watched drive


@dataclass(frozen=True)
class CourseUnderTest:
    """One of evaluation's courses, with its launch file, model, and the nodes that drive."""

    name: str
    launch: tuple[str, str]  # package, file
    robot: str
    follower: str
    drivers: tuple[str, ...]  # nodes without which the car must stand still
    by_hand: ByHand


COURSES = {course.name: course for course in (
    CourseUnderTest("course", ("learning_topic", "course_follow.launch"), "turtlebot3_waffle",
                    "07follower_ground.py", ("follower",),
                    ByHand(("learning_topic", "0course.launch", "command_timeout:=0.3", *SIZE),
                           {"follower": ("learning_topic", "07follower_ground.py")})),
    CourseUnderTest("race", ("racecar_description", "race.launch"), "racecar", "lane_follow.py",
                    ("follower", "motor_control"),
                    ByHand(("racecar_description", "car_control.launch", "keyboard:=false",
                            "ackermann:=true", "command_timeout:=true", *SIZE),
                           {"follower": ("car_control", "lane_follow.py"),
                            "motor_control": ("car_control", "motor_control.py",
                                              "_ackermann:=true")})),
    CourseUnderTest("lane_empty", ("lane_keeping", "run_empty.launch"), "lane_car",
                    "sliding_windows.py", ("lane_keeping",),
                    ByHand(("lane_keeping", "lane.launch", "command_timeout:=true", *SIZE),
                           {"lane_keeping": ("lane_keeping", "lane_keeping_node.py",
                                             "_method:=sliding_windows")})),
)}
WATCHED = """<launch>
  <param name="/gazebo/state_log" value="{states}"/>
  <include file="$(find {package})/launch/{file}" pass_all_args="true"/>
</launch>
"""
