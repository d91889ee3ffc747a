"""Eight waffles that drive, in the core without ROS: what a simulated second costs.

It is 1000 steps, which are its `physics`, with each robot's drive and odometry at 30 Hz and its
360 rays at 5 Hz, as the waffle has them; cameras are the part `renderer`.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.sensors.laser import Laser
from bullet_sim.sensors.odometry import true_odometry
from bullet_sim.world import World
from sim_bench.course import drive_of, sensor_with
from sim_bench.figures import Figure, figure
from sim_bench.parts.step import open_course
from sim_bench.settings import Settings, say

ROBOTS = 8
RUNS = 5
STEPS_BETWEEN = (33, 33, 34) * 10  # steps of one simulated second between two drive updates
SWEEP_EVERY = 6  # drive updates: 5 Hz
SPEED, YAW_RATE = 0.15, 0.5  # m/s, rad/s: a circle of 0.3 m radius
SPACING = 1.0  # m


def measure(settings: Settings) -> list[Figure]:
    """Wall ms of a simulated second, what our steps take of it, and what the engine alone takes."""
    say(f"{ROBOTS} robots")
    course, bare = open_course()
    robots = [_Robot(course.world, course.spawn_waffle(f"waffle{i}", Pose((x, y, 0.0))))
              for i, (x, y) in enumerate([(0.0, 0.0), *grid(ROBOTS - 1)])]
    _second(course.world, robots)  # until all are up to speed
    runs = [(*_second(course.world, robots), _bare_second(bare))
            for _ in range(settings.runs(RUNS))]
    course.close()
    names = (f"robots.{ROBOTS}", f"physics.robots.{ROBOTS}", f"engine.robots.{ROBOTS}")
    return [figure(name, "ms a simulated s", values) for name, values in zip(names, zip(*runs))]


def grid(count: int, spacing: float = SPACING) -> list[tuple[float, float]]:
    """The first places (m) of a square grid around the origin, nearest first; not its middle."""
    reach = math.ceil(math.sqrt(count + 1))
    steps = range(-reach, reach + 1)
    places = [(i * spacing, j * spacing) for i in steps for j in steps if i or j]
    return sorted(places, key=lambda place: (math.hypot(*place), place))[:count]


class _Robot:
    """A waffle that drives a circle, with what its plugins do without a camera."""

    def __init__(self, world: World, model: Model):
        self._world, self._model = world, model
        self._drive = drive_of(model, SPEED, YAW_RATE)
        self._laser = Laser(world, *sensor_with(model, "ray"))

    def update(self, sweep: bool) -> None:
        true_odometry(self._world, self._model)
        self._drive.update(1 / 30)
        if sweep:
            self._laser.sample()


def _second(world: World, robots: list[_Robot]) -> tuple[float, float]:
    """Wall ms of one simulated second, and what stepping the engine takes of it."""
    start, stepped = time.perf_counter(), world.profiler.totals().get("physics", 0.0)
    for number, steps in enumerate(STEPS_BETWEEN):
        world.step(steps)
        for robot in robots:
            robot.update(sweep=number % SWEEP_EVERY == 0)
    took = time.perf_counter() - start
    return took * 1e3, (world.profiler.totals()["physics"] - stepped) * 1e3


def _bare_second(bare: Callable[[], None]) -> float:
    """Wall ms of the same steps by the engine alone; the wheels keep their last command."""
    start = time.perf_counter()
    for _ in range(sum(STEPS_BETWEEN)):
        bare()
    return (time.perf_counter() - start) * 1e3
