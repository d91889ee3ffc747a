"""How far the simulator's way of solving a drive is from the exact solution, and what it costs.

Five robots drive straight, in a circle, on the spot and over two bumps, at several speeds: as the
simulator does it, `ours` (see `held_wheels` of the core); `coarse`, as all drives were solved
before, until no row changes by 3 mm/s; and exactly. Errors of yaw (degrees) and
distance driven (mm) are those after 5 s; a figure's runs are the speeds.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

from bullet_sim.description import (
    Collision,
    Cylinder,
    LinkDescription,
    ModelDescription,
    PhysicsDescription,
    Plane,
    Surface,
    WorldDescription,
)
from bullet_sim.pose import Pose
from bullet_sim.world import World
from sim_bench.driven import LAID, ROBOTS, TRACK, spawn
from sim_bench.figures import Figure, figure
from sim_bench.settings import Settings

WAYS = {
    "ours": PhysicsDescription(),
    "coarse": PhysicsDescription(residual=1e-5),
    "exact": PhysicsDescription(residual=1e-9, iterations=1000),
}
SPEEDS = (0.05, 0.15, 0.5, 1.0)  # m/s
CIRCLE = {"racecar": 1.0}  # m, radius; others 0.5
KINDS = ("straight", "circle", "spot", "bump")
STANDING, DRIVING, PIECE = 300, 5000, 100  # steps
BUMP = 0.004  # m, height of a rod of 0.2 m that is sunk in the ground
GRIP = Surface(mu=100.0, mu2=50.0)  # as the courses' ground


@dataclass(frozen=True)
class Way:
    """What came of a drive."""

    yaw: float  # degrees
    distance: float  # mm, along the way
    step: float  # us of processor time


def measure(settings: Settings) -> list[Figure]:
    """Means over the kinds of drive would hide the worst: a figure for each."""
    speeds = SPEEDS[1:2] if settings.quick else SPEEDS
    found = []
    for robot in ROBOTS:
        for kind in KINDS:
            if robot == "racecar" and kind == "spot":
                continue
            found += _compare(robot, kind, speeds)
    return found


def _compare(robot: str, kind: str, speeds: tuple[float, ...]) -> list[Figure]:
    ways = {name: [drive(robot, kind, speed, physics) for speed in speeds]
            for name, physics in WAYS.items()}
    found = []
    for name in ("ours", "coarse"):
        pairs = list(zip(ways[name], ways["exact"], strict=True))
        label = f"{robot}.{kind}.{name}"
        found += [
            figure(f"yaw_error.{label}", "deg", [abs(own.yaw - true.yaw) for own, true in pairs]),
            figure(f"distance_error.{label}", "mm",
                   [abs(own.distance - true.distance) for own, true in pairs]),
            figure(f"step.{label}", "us", [own.step for own, _ in pairs])]
    return found


def drive(robot: str, kind: str, speed: float, physics: PhysicsDescription) -> Way:
    """Drive a robot of `sim_bench.driven` for some seconds; `speed` in m/s, that of the rims."""
    bumps = [_bump(x) for x in (0.3 + speed / 4, 1.0)] if kind == "bump" else []
    world = World(WorldDescription(models=(_ground(), *bumps), physics=physics))
    try:
        model, go = spawn(world, robot)
        go(STANDING, 0.0, 0.0)
        forward = 0.0 if kind == "spot" else speed
        turn = {"spot": lambda: 2 * speed / TRACK[robot],
                "circle": lambda: speed / CIRCLE.get(robot, 0.5)}.get(kind, lambda: 0.0)()
        yaw, distance, last = 0.0, 0.0, model.pose
        began = time.process_time()
        for _ in range(DRIVING // PIECE):
            go(PIECE, forward, turn)
            now = model.pose
            yaw += math.remainder(now.rpy()[2] - last.rpy()[2], 2 * math.pi)
            distance += math.dist(now.position[:2], last.position[:2])
            last = now
        spent = time.process_time() - began
    finally:
        world.close()
    return Way(math.degrees(yaw), 1e3 * distance, 1e6 * spent / DRIVING)


def _ground() -> ModelDescription:
    return _fixed("ground", Collision("c", Plane((0.0, 0.0, 1.0), (99.0, 99.0)), surface=GRIP))


def _bump(x: float) -> ModelDescription:
    pose = Pose((x, 0.0, BUMP - 0.2)) * LAID
    return _fixed(f"bump_{x:g}", Collision("c", Cylinder(0.2, 20.0), pose, GRIP))


def _fixed(name: str, collision: Collision) -> ModelDescription:
    return ModelDescription(name, static=True,
                            links=(LinkDescription("link", collisions=(collision,)),))
