"""What is driven in a round, and how its processes are known."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Course:
    """One of evaluation's courses, with its launch file, model, driver and who moves the car."""

    name: str
    launch: tuple[str, str]  # package, file
    robot: str
    follower: str
    drivers: tuple[str, ...]  # nodes without which the car is to stand


COURSES = {course.name: course for course in (
    Course("course", ("learning_topic", "course_follow.launch"), "turtlebot3_waffle",
           "07follower_ground.py", ("follower",)),
    Course("race", ("racecar_description", "race.launch"), "racecar", "lane_follow.py",
           ("follower", "motor_control")),
    Course("lane_empty", ("lane_keeping", "run_empty.launch"), "lane_car", "sliding_windows.py",
           ("lane_keeping",)),
)}
WATCHED = """<launch>
  <param name="/gazebo/state_log" value="{states}"/>
  <include file="$(find {package})/launch/{file}" pass_all_args="true"/>
</launch>
"""
