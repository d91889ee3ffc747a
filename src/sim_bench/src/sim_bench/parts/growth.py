"""What more robots, more obstacles and more laser rays cost, in the core without ROS.

A simulated second of robots is 1000 steps, which are its `physics`, with each robot's drive and
odometry at 30 Hz and its 360 rays at 5 Hz, as the waffle has them; cameras are the part `renderer`.
Obstacles stand on a grid around one waffle: held fast, or loose boxes that the engine has to
balance.
"""

from __future__ import annotations

import dataclasses
import math
import time

from bullet_sim.description import (
    Box,
    Collision,
    Inertial,
    LinkDescription,
    ModelDescription,
    SensorDescription,
    Visual,
)
from bullet_sim.drives.diff_drive import DiffDrive
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.sensors.laser import Laser
from bullet_sim.sensors.odometry import true_odometry
from bullet_sim.world import World
from sim_bench.course import Course, drive_of, laser_of
from sim_bench.figures import Figure, figure
from sim_bench.settings import Settings

ROBOTS = (1, 2, 4, 8)
OBSTACLES = (1, 4, 16, 64)
RAYS = (360, 720, 1440, 2048, 4096)
RUNS, SWEEPS = 5, 10  # of each count; sweeps of which a run takes the mean
STEPS_BETWEEN = (33, 33, 34) * 10  # steps of one simulated second between two drive updates
SWEEP_EVERY = 6  # drive updates: 5 Hz
SPEED, YAW_RATE = 0.15, 0.5  # m/s, rad/s: a circle of 0.3 m radius
SPACING, BOX_SIDE, BOX_MASS = 1.0, 0.2, 1.0  # m, m, kg


def measure(settings: Settings) -> list[Figure]:
    """Wall milliseconds of a simulated second, by robots and obstacles; of a sweep, by rays."""
    settings.say("robots: " + ", ".join(map(str, ROBOTS)))
    found = _side_by_side([_with_robots(count) for count in ROBOTS], settings)
    for kind, fixed in (("fixed", True), ("loose", False)):
        settings.say(f"{kind} boxes: " + ", ".join(map(str, OBSTACLES)))
        scenes = [_with_obstacles(count, kind, fixed) for count in OBSTACLES]
        found += _side_by_side(scenes, settings)
    settings.say("rays: " + ", ".join(map(str, RAYS)))
    return found + _rays(settings)


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
        self._drive: DiffDrive = drive_of(model)
        self._drive.command(SPEED, YAW_RATE)
        link, sensor = laser_of(model)
        self._laser = Laser(world, link, sensor)

    def update(self, sweep: bool) -> None:
        true_odometry(self._world, self._model)
        self._drive.update(1 / 30)
        if sweep:
            self._laser.sample()


@dataclasses.dataclass(frozen=True)
class _Scene:
    """A course whose simulated seconds are timed."""

    name: str  # of the figure
    course: Course
    robots: list[_Robot]

    def second(self) -> tuple[float, float]:
        """Wall ms of one simulated second, and what stepping the engine takes of it."""
        profiler = self.course.world.profiler
        start, stepped = time.perf_counter(), profiler.totals().get("physics", 0.0)
        _simulate_second(self.course.world, self.robots)
        took = time.perf_counter() - start
        return took * 1e3, (profiler.totals()["physics"] - stepped) * 1e3


def _with_robots(count: int) -> _Scene:
    course = Course()
    places = [(0.0, 0.0), *grid(count - 1)]
    robots = [
        _Robot(course.world, course.spawn_waffle(f"waffle{i}", Pose((x, y, 0.0))))
        for i, (x, y) in enumerate(places)
    ]
    return _Scene(f"robots.{count}", course, robots)


def _with_obstacles(count: int, kind: str, fixed: bool) -> _Scene:
    course = Course()
    robot = _Robot(course.world, course.spawn_waffle())
    _put_boxes(course.world, count, fixed)
    return _Scene(f"obstacles.{kind}.{count}", course, [robot])


def _side_by_side(scenes: list[_Scene], settings: Settings) -> list[Figure]:
    """The scenes take turns, a simulated second each."""
    runs: dict[str, list[tuple[float, float]]] = {scene.name: [] for scene in scenes}
    for scene in scenes:
        scene.second()  # until all have come to rest or up to speed
    for _ in range(settings.runs(RUNS)):
        for scene in scenes:
            runs[scene.name].append(scene.second())
    for scene in scenes:
        scene.course.close()
    return [figure(kind + name, "ms a simulated s", values)
            for name, both in runs.items()
            for kind, values in zip(("", "physics."), zip(*both))]


def _simulate_second(world: World, robots: list[_Robot]) -> None:
    for number, steps in enumerate(STEPS_BETWEEN):
        world.step(steps)
        for robot in robots:
            robot.update(sweep=number % SWEEP_EVERY == 0)


def _rays(settings: Settings) -> list[Figure]:
    course = Course()
    waffle = course.spawn_waffle()
    link, sensor = laser_of(waffle)
    _put_boxes(course.world, 16, fixed=True)
    course.world.step()
    lasers = {count: _laser(course.world, link, sensor, count) for count in RAYS}
    runs: dict[int, list[float]] = {count: [] for count in RAYS}
    for _ in range(settings.runs(RUNS)):
        for count, laser in lasers.items():
            runs[count].append(_sweep(laser, waffle) * 1e3)
    course.close()
    return [figure(f"rays.{count}", "ms a sweep", values) for count, values in runs.items()]


def _laser(world: World, link: Link, sensor: SensorDescription, count: int) -> Laser:
    """The waffle's laser with another number of rays."""
    ray = dataclasses.replace(sensor.ray, samples=count)
    return Laser(world, link, dataclasses.replace(sensor, ray=ray))


def _sweep(laser: Laser, waffle: Model) -> float:
    """s of a sweep; the robot turns on before each, so that no two are alike."""
    seconds = 0.0
    for number in range(SWEEPS):
        waffle.set_pose(Pose.from_xyz_rpy(waffle.pose.position, (0.0, 0.0, 0.1 * number)))
        start = time.perf_counter()
        laser.sample()
        seconds += time.perf_counter() - start
    return seconds / SWEEPS


def _put_boxes(world: World, count: int, fixed: bool) -> None:
    """Boxes on the floor, on a grid whose middle stays free for the robot."""
    shape = Box((BOX_SIDE, BOX_SIDE, BOX_SIDE))
    inertia = BOX_MASS * BOX_SIDE**2 / 6
    link = LinkDescription(
        "link",
        inertial=Inertial(BOX_MASS, inertia=(inertia, 0.0, 0.0, inertia, 0.0, inertia)),
        visuals=(Visual("visual", shape),),
        collisions=(Collision("collision", shape),),
    )
    for number, (x, y) in enumerate(grid(count)):
        box = ModelDescription(f"box{number}", static=fixed, links=(link,))
        world.spawn(box, Pose((x, y, BOX_SIDE / 2)))
