"""Ten waffles in one world: until all stand in it, and until each publishes odometry and scan.

Once by services from one process, one call after the other, and once as people do it: by a launch
file with a group and a `spawn_model` for each robot, where ten interpreters start besides.
"""

from __future__ import annotations

import time
from pathlib import Path

import rospkg

from bullet_sim.formats.xacro.files import expand
from run_session import simulator
from sim_bench.figures import Figure, figure
from sim_bench.parts.growth import grid
from sim_bench.ros_run import START_LIMIT, RosRun, read_lines, ros_run
from sim_bench.settings import Settings

COUNT, TOPICS_EACH = 10, 2
RUNS = 3
SPACING = 0.6  # m
WINDOW = 4.0  # s, wall, with everything being published
NAMES = tuple(f"tb{number}" for number in range(1, COUNT + 1))


def measure(settings: Settings) -> list[Figure]:
    """Seconds on the wall, and the real-time factor with all of them at work."""
    packages = rospkg.RosPack()
    world = Path(packages.get_path("learning_topic")) / "worlds" / "course.world"
    with ros_run(settings, "robots") as run:
        run.launch("gazebo_ros", "empty_world.launch", "gui:=false", f"world_name:={world}")
        run.wait(simulator.models, START_LIMIT, "the simulator")
        settings.say(f"{COUNT} waffles by services")
        found = _by_services(run, packages, settings)
        settings.say(f"{COUNT} waffles by a launch file")
        return found + _by_launch_file(run, settings)


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


def _by_services(
    run: RosRun, packages: rospkg.RosPack, settings: Settings
) -> list[Figure]:
    folder = Path(packages.get_path("turtlebot3_description"))
    text = expand(
        folder / "urdf" / "turtlebot3_waffle.urdf.xacro", find_package=packages.get_path
    )
    spawned, publishing, factors = [], [], []
    for _ in range(settings.runs(RUNS)):
        fleet = _Fleet(run)
        began = time.monotonic()
        for name, (x, y) in zip(NAMES, grid(COUNT, SPACING)):
            simulator.spawn_urdf(name, text, name, x, y)
        spawned.append(time.monotonic() - began)
        publishing.append(fleet.wait_for_all() - began)
        factors.append(_real_time_factor(run, settings.seconds(WINDOW)))
        fleet.end()
    return [
        figure("spawned", "s", spawned),
        figure("publishing", "s", publishing),
        figure("real_time_factor", "x", factors),
    ]


def _by_launch_file(run: RosRun, settings: Settings) -> list[Figure]:
    file = run.folder / "ten_waffles.launch"
    file.write_text(launch_file_text(), encoding="utf-8")
    spawned, publishing = [], []
    for _ in range(settings.runs(RUNS)):
        fleet = _Fleet(run)
        began = time.monotonic()
        launched = run.start("ten_waffles", ["roslaunch", "-p", str(run.port), str(file)])
        run.forget(launched)  # it ends by itself: all its nodes do
        run.wait(lambda: set(NAMES) <= set(simulator.models()), START_LIMIT, "ten waffles")
        spawned.append(time.monotonic() - began)
        publishing.append(fleet.wait_for_all() - began)
        fleet.end()
        run.wait(lambda child=launched: child.process.poll() is not None, START_LIMIT, "its end")
    return [
        figure("launched.spawned", "s", spawned),
        figure("launched.publishing", "s", publishing),
    ]


class _Fleet:
    """A subscriber to all odometry and scans, already waiting when the robots come."""

    def __init__(self, run: RosRun):
        self._run, self._file = run, run.folder / "fleet.txt"
        self._file.unlink(missing_ok=True)
        self._probe = run.probe("fleet", str(self._file), *NAMES)
        run.wait(lambda: read_lines(self._file), START_LIMIT, "the subscriber")

    def wait_for_all(self) -> float:
        """The wall time (s) at which the last topic spoke first; RunError if one stays silent."""
        wanted = 1 + COUNT * TOPICS_EACH
        self._run.wait(
            lambda: len(read_lines(self._file)) == wanted, START_LIMIT, "odometry and scan of all"
        )
        return read_lines(self._file)[-1][0]

    def end(self) -> None:
        """End the subscriber and take the robots out."""
        self._run.end(self._probe)
        for name in NAMES:
            simulator.delete(name)


def _real_time_factor(run: RosRun, seconds: float) -> float:
    began, start = time.monotonic(), simulator.simulated_time()
    run.pause(seconds)
    return (simulator.simulated_time() - start) / (time.monotonic() - began)
