"""Ten waffles in one world, until all stand in it.

Once by services from one process, one call after the other, and once as people do it: by a launch
file with a group and a `spawn_model` for each robot, where ten interpreters start besides.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

from driving_courses.packages import find_file

from run_session import simulator
from sim_bench.course import COURSE, waffle_text
from sim_bench.figures import Figure, figure
from sim_bench.parts.growth import grid
from sim_bench.ros_run import RosRun, ros_run
from sim_bench.settings import Settings, say

COUNT, RUNS = 10, 3
PLACES = {f"tb{number}": place for number, place in enumerate(grid(COUNT, 0.6), start=1)}  # m
GROUP = """\
  <group ns="{0}">
    <node name="spawn" pkg="gazebo_ros" type="spawn_model" output="screen"
          args="-urdf -param /robot_description -model {0} -robot_namespace {0} -x {1} -y {2}"/>
  </group>
"""
URDF = "$(find turtlebot3_description)/urdf/turtlebot3_waffle.urdf.xacro"


def measure(settings: Settings) -> list[Figure]:
    """Seconds on the wall."""
    with ros_run(settings, "robots") as run:
        run.launch_world(f"world_name:={find_file(COURSE.world)}")
        say(f"{COUNT} waffles by services, then by a launch file")
        ways = {"spawned": partial(_by_services, waffle_text()),
                "launched.spawned": partial(_by_launch_file, run)}
        return [figure(name, "s", [_timed(way) for _ in range(settings.runs(RUNS))])
                for name, way in ways.items()]


def launch_file_text() -> str:
    """A launch file that spawns all robots, each in a group of its own."""
    groups = "".join(GROUP.format(name, x, y) for name, (x, y) in PLACES.items())
    command = f'  <param name="robot_description" command="$(find xacro)/xacro {URDF}"/>'
    return f"<launch>\n{command}\n{groups}</launch>\n"


def _timed(spawn_all: Callable[[], None]) -> float:
    began = time.monotonic()
    spawn_all()
    took = time.monotonic() - began
    for name in PLACES:
        simulator.delete(name)
    return took


def _by_services(text: str) -> None:
    for name, (x, y) in PLACES.items():
        simulator.spawn_urdf(name, text, name, x, y)


def _by_launch_file(run: RosRun) -> None:
    file = run.log_folder / "ten_waffles.launch"
    file.write_text(launch_file_text(), encoding="utf-8")
    launched = run.launch(str(file))
    run.wait(lambda: set(PLACES) <= set(simulator.models()), "ten waffles")
    run.stop(launched)
