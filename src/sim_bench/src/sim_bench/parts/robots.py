"""Ten waffles in one world, until all stand in it.

Once by services from one process, one call after the other, and once as people do it: by a launch
file with a group and a `spawn_model` for each robot, where ten interpreters start besides.
"""

from __future__ import annotations

import time
from pathlib import Path

import rospkg

from run_session import simulator
from sim_bench.course import waffle_text
from sim_bench.figures import Figure, figure
from sim_bench.parts.growth import grid
from sim_bench.ros_run import RosRun, ros_run
from sim_bench.settings import Settings, say

COUNT, RUNS = 10, 3
SPACING = 0.6  # m
NAMES = tuple(f"tb{number}" for number in range(1, COUNT + 1))


def measure(settings: Settings) -> list[Figure]:
    """Seconds on the wall."""
    world = Path(rospkg.RosPack().get_path("learning_topic")) / "worlds" / "course.world"
    text = waffle_text()
    with ros_run(settings, "robots") as run:
        run.launch_world(f"world_name:={world}")
        say(f"{COUNT} waffles by services, then by a launch file")
        runs = range(settings.runs(RUNS))
        return [figure("spawned", "s", [_by_services(text) for _ in runs]),
                figure("launched.spawned", "s", [_by_launch_file(run) for _ in runs])]


def launch_file_text() -> str:
    """A launch file that spawns all robots, each in a group of its own."""
    groups = [
        f'  <group ns="{name}">\n'
        f'    <node name="spawn" pkg="gazebo_ros" type="spawn_model" output="screen"\n'
        f'          args="-urdf -param /robot_description -model {name} -robot_namespace {name}'
        f' -x {x} -y {y}"/>\n'
        f"  </group>"
        for name, (x, y) in zip(NAMES, grid(COUNT, SPACING))
    ]
    urdf = "$(find turtlebot3_description)/urdf/turtlebot3_waffle.urdf.xacro"
    command = f'  <param name="robot_description" command="$(find xacro)/xacro {urdf}"/>'
    return "\n".join(["<launch>", command, *groups, "</launch>", ""])


def _by_services(text: str) -> float:
    began = time.monotonic()
    for name, (x, y) in zip(NAMES, grid(COUNT, SPACING)):
        simulator.spawn_urdf(name, text, name, x, y)
    took = time.monotonic() - began
    _take_out()
    return took


def _by_launch_file(run: RosRun) -> float:
    file = run.log_folder / "ten_waffles.launch"
    file.write_text(launch_file_text(), encoding="utf-8")
    began = time.monotonic()
    launched = run.launch(str(file))
    run.wait(lambda: set(NAMES) <= set(simulator.models()), "ten waffles")
    took = time.monotonic() - began
    run.stop(launched)
    _take_out()
    return took


def _take_out() -> None:
    for name in NAMES:
        simulator.delete(name)
