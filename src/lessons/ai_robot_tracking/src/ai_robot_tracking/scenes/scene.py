"""Scenes drawn from a seed: the red cylinder's path, and what makes it hard to see.

The room is square; its middle is the world's origin, where the car starts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

STATIC, MOVING, LIGHT, OCCLUSION, DISTRACTORS = KINDS = (
    "static", "moving", "light", "occlusion", "distractors")
HALF_ROOM = 5.0             # m from the middle to a wall
HALF_REACH = 3.0            # m, the cylinder's farthest place from the middle, along x and y
SPEED, STEP = 0.3, 0.5      # m/s; s between two waypoints
DURATION = 120.0            # s of path before it returns along the same path
MOST_TURN = 0.8             # rad/s, so that no bend is narrower than 0.375 m
TURN_TIME = (1.0, 3.0)      # s between two changes of the turn rate
START_DISTANCE, START_BEARING = (1.5, 3.0), math.radians(30)  # of the cylinder, from the car
STANDING = (3.0, 1.0)       # m, x and y of the cylinder that does not move
HIDDEN_TIME = 3.0           # s under the hood
HIDDEN_AT = ((18.0, 24.0), (40.0, 46.0))  # s, when the hood comes down
FALL_TIME = 0.2             # s that the hood takes to come down, or to rise
HOOD_UP = 2.6               # m above its lower position
SUN = (0.6, 1.0)            # times the usual strength
SHADE_RADIUS = 1.5          # m
SIDE = 4.3                  # m from the middle to the distractors

Place = tuple[float, float]


@dataclass(frozen=True)
class Lookalike:
    """Something red or nearly red that is not the cylinder."""

    shape: str  # cylinder, ball, box
    colour: tuple[float, float, float]
    place: tuple[float, float, float]  # x, y, m; yaw, rad


@dataclass(frozen=True)
class Scene:
    """Everything that a world file describes."""

    kind: str
    seed: int
    way: np.ndarray                     # (N, 3): s, x, y of the cylinder; one row: it stands still
    hidden: tuple[float, ...] = ()      # s, times from which it is under the hood for HIDDEN_TIME
    sun: float = 1.0                    # times its usual strength
    shades: tuple[Place, ...] = ()      # m, centres of round patches of shade
    lookalikes: tuple[Lookalike, ...] = ()


def draw_scene(kind: str, seed: int) -> Scene:
    """The scene of this kind, one of KINDS, for a seed."""
    if kind == STATIC:
        return Scene(kind, seed, np.array([(0.0, *STANDING)]))
    random = np.random.default_rng([KINDS.index(kind), seed])
    way = random_way(random)
    if kind == OCCLUSION:
        return Scene(kind, seed, way, hidden=tuple(random.uniform(*span) for span in HIDDEN_AT))
    if kind == LIGHT:
        return Scene(kind, seed, way, sun=random.uniform(*SUN), shades=_shades(random))
    if kind == DISTRACTORS:
        return Scene(kind, seed, way, lookalikes=_lookalikes(random))
    return Scene(kind, seed, way)


def random_way(random: np.random.Generator, duration: float = DURATION) -> np.ndarray:
    """A path (N, 3) of s, x, y at SPEED that bends at random, and back along the same path."""
    distance, bearing = random.uniform(*START_DISTANCE), random.uniform(-1, 1) * START_BEARING
    place = np.array([distance * math.cos(bearing), distance * math.sin(bearing)])
    heading, turn, until = random.uniform(-math.pi, math.pi), 0.0, 0.0
    places = [place]
    for number in range(round(duration / STEP)):
        now = number * STEP
        if now >= until:
            turn, until = random.uniform(-MOST_TURN, MOST_TURN), now + random.uniform(*TURN_TIME)
        inwards = math.remainder(math.atan2(-place[1], -place[0]) - heading, math.tau)
        if _near_edge(place) and abs(inwards) > math.pi / 4:
            turn = math.copysign(MOST_TURN, inwards)
        heading += turn * STEP
        place = place + SPEED * STEP * np.array([math.cos(heading), math.sin(heading)])
        places.append(place)
    there = np.array(places)
    everything = np.concatenate([there, there[-2::-1]])
    return np.column_stack([np.arange(len(everything)) * STEP, everything])


def _near_edge(place: np.ndarray) -> bool:
    """Whether to turn back now; a half turn takes it another 0.75 m outwards."""
    return bool(np.max(np.abs(place)) > HALF_REACH - 0.75)


def _shades(random: np.random.Generator) -> tuple[Place, ...]:
    """Two patches of shade, in opposite quarters of the room."""
    x, y = random.uniform(0.8, 2.0, 2) * random.choice((-1, 1), 2)
    return (float(x), float(y)), (float(-x), float(-y))


def _lookalikes(random: np.random.Generator) -> tuple[Lookalike, ...]:
    """Distractors along the walls: its colour in another shape, its shape in another colour."""
    red, orange, pink = (1.0, 0.0, 0.0), (1.0, 0.28, 0.0), (1.0, 0.35, 0.45)
    found = []
    kinds = (("ball", red), ("cylinder", orange), ("box", red), ("cylinder", pink))
    for side, (shape, colour) in enumerate(kinds):
        along = random.uniform(-3.0, 3.0)
        angle = side * math.pi / 2
        x = SIDE * math.cos(angle) - along * math.sin(angle)
        y = SIDE * math.sin(angle) + along * math.cos(angle)
        found.append(Lookalike(shape, colour, (x, y, angle)))
    return tuple(found)


START_AWAY = 1.5     # m from the standing cylinder, at least
START_REACH = 4.0    # m from the room's middle, along x and along y


@dataclass(frozen=True)
class Start:
    """Where the car starts; m, rad."""

    x: float
    y: float
    yaw: float


def draw_start(kind: str, seed: int) -> Start:
    """Anywhere in the room if the cylinder stands; in the middle, facing it, if it moves."""
    if kind != STATIC:
        return Start(0.0, 0.0, 0.0)
    random = np.random.default_rng(seed)
    while True:
        x, y = random.uniform(-START_REACH, START_REACH, 2)
        if math.dist((x, y), STANDING) >= START_AWAY:
            return Start(float(x), float(y), float(random.uniform(-math.pi, math.pi)))
