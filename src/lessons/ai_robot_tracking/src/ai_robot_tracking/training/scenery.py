"""The surroundings: floor, walls, lamps, and objects of none of the five classes."""

from __future__ import annotations

import math

import numpy as np

from ai_robot_tracking.training.patterns import FLOOR_PX, any_colour, any_red, pattern
from ai_robot_tracking.training.things import (
    Images,
    Thing,
    ball,
    box,
    coloured,
    covered,
    plane,
    plate,
    post,
)
from bullet_sim.description import Fog, LightDescription, SceneDescription
from bullet_sim.meshes.part import MeshPart
from bullet_sim.pose import Pose

WALL_HEIGHT = (0.4, 3.5)  # m
FLOOR_SIDE = 40.0  # m


def surroundings(rng: np.random.Generator, room: float, images: Images) -> tuple[MeshPart, ...]:
    """A floor, and usually walls, about `room` m from the camera at the origin."""
    ground = covered(images, pattern(rng, FLOOR_PX))
    side = FLOOR_SIDE if rng.random() < 0.3 else rng.uniform(1.0, 2.5) * room
    parts = [plane(side, 0.0, ground)]
    if side < FLOOR_SIDE:
        parts.append(plane(FLOOR_SIDE, -0.02, coloured(any_colour(rng))))
    if rng.random() < 0.75:
        parts += _walls(rng, room, images)
    return tuple(parts)


def lamps(rng: np.random.Generator) -> list[LightDescription]:
    """A sun or ceiling light, usually a weaker one next to the camera, sometimes a lamp nearby.

    Without the second, a cylinder seen from its dark side at eye height is a plain rectangle.
    """
    tint = 1 - rng.uniform(0, 0.25, 3)
    found = [_far_light("sun", rng.uniform(0.45, 1.0) * tint,
                        (*rng.uniform(-1, 1, 2).tolist(), -rng.uniform(0.2, 1.2)))]
    if rng.random() < 0.75:
        aside = rng.uniform(0.3, 1.0) * rng.choice([-1.0, 1.0])
        found.append(_far_light("fill", rng.uniform(0.2, 0.6) * tint,
                                (rng.uniform(0.2, 1.0), aside, -rng.uniform(0.1, 0.6))))
    if rng.random() < 0.3:
        place = Pose((rng.uniform(0, 6), rng.uniform(-4, 4), rng.uniform(1.5, 4)))
        found.append(LightDescription("lamp", "point", place, _rgba(rng.uniform(0.3, 1, 3)),
                                      (0, 0, 0, 1), range=15.0, linear=0.2))
    return found


def _far_light(name: str, colour: np.ndarray, direction: tuple) -> LightDescription:
    return LightDescription(name, "directional", diffuse=_rgba(colour), specular=(0, 0, 0, 1),
                            direction=tuple(float(part) for part in direction))


def air(rng: np.random.Generator) -> SceneDescription:
    """Ambient light, and the background."""
    ambient = _rgba(rng.uniform(0.25, 0.8) * (1 - rng.uniform(0, 0.2, 3)))
    fog = Fog()
    if rng.random() < 0.08:
        fog = Fog("linear", _rgba(rng.uniform(0.4, 1.0, 3)), 2.0, rng.uniform(15.0, 60.0))
    return SceneDescription(ambient, (*any_colour(rng), 1.0), False, bool(rng.random() < 0.35), fog)


def distractor(rng: np.random.Generator, images: Images) -> Thing:
    """A box, ball, table, tree, other sign, or arch of any colour."""
    kind = rng.choice([_box, _box, _ball, _table, _tree, _other_sign, _gate])
    return kind(rng, images)


def _box(rng: np.random.Generator, images: Images) -> Thing:
    size = rng.uniform(0.1, 1.0, 3) * rng.uniform(0.4, 1.8)
    if rng.random() < 0.35:
        material = covered(images, pattern(rng))
    else:
        material = coloured(any_colour(rng, saturated=rng.random() < 0.5))
    part = box(tuple(size.tolist()), (0, 0, size[2] / 2), material)
    return Thing(None, (part,), (), Pose(), math.hypot(size[0], size[1]) / 2)


def _ball(rng: np.random.Generator, images: Images) -> Thing:
    radius = rng.uniform(0.05, 0.5)
    material = coloured(any_colour(rng, saturated=rng.random() < 0.6))
    return Thing(None, (ball(radius, (0, 0, radius), material),), (), Pose(), radius)


def _table(rng: np.random.Generator, images: Images) -> Thing:
    long, wide, high = rng.uniform(0.4, 1.4), rng.uniform(0.4, 0.9), rng.uniform(0.3, 0.9)
    wood = coloured(any_colour(rng))
    parts = [box((long, wide, 0.04), (0, 0, high), wood)]
    for x in (-1, 1):
        for y in (-1, 1):
            at = (x * (long / 2 - 0.04), y * (wide / 2 - 0.04), high / 2)
            parts.append(box((0.05, 0.05, high), at, wood))
    return Thing(None, tuple(parts), (), Pose(), math.hypot(long, wide) / 2)


def _tree(rng: np.random.Generator, images: Images) -> Thing:
    high = rng.uniform(0.8, 3.5)
    green = coloured((rng.uniform(0.05, 0.3), rng.uniform(0.25, 0.6), rng.uniform(0.05, 0.25)))
    side = 0.05 * high
    parts = [box((side, side, high), (0, 0, high / 2), coloured((0.35, 0.24, 0.14)))]
    for _ in range(int(rng.integers(2, 6))):
        x, y = rng.uniform(-0.12, 0.12, 2) * high
        parts.append(ball(high * rng.uniform(0.12, 0.24), (x, y, high * rng.uniform(0.75, 1.05)),
                          green))
    return Thing(None, tuple(parts), (), Pose(), 0.3 * high)


def _other_sign(rng: np.random.Generator, images: Images) -> Thing:
    """Round, three- or four-cornered, often red: what a stop sign must be distinguished from."""
    radius = rng.uniform(0.08, 0.45)
    high = radius * rng.uniform(2.0, 7.0)
    sides = int(rng.choice([3, 4, 32]))
    red = any_red(rng)
    colour = red if rng.random() < 0.4 else any_colour(rng, saturated=True)
    grey = coloured((0.5, 0.5, 0.52))
    own = list(plate(sides, radius, (0.12 * radius, 0, high), coloured(colour), grey))
    if rng.random() < 0.7:
        inner = coloured((0.95, 0.95, 0.95) if rng.random() < 0.6 else any_colour(rng))
        own.append(plate(sides, 0.7 * radius, (0.14 * radius, 0, high), inner, grey)[0])
    return Thing(None, tuple(own), (post(rng, radius, high),), Pose(), radius)


def _gate(rng: np.random.Generator, images: Images) -> Thing:
    wide, high, thick = rng.uniform(0.6, 2.0), rng.uniform(0.5, 2.2), rng.uniform(0.05, 0.2)
    material = coloured(any_colour(rng))
    parts = [box((thick, thick, high), (0, y * wide / 2, high / 2), material) for y in (-1, 1)]
    parts.append(box((thick, wide + thick, thick), (0, 0, high), material))
    return Thing(None, tuple(parts), (), Pose(), wide / 2)


def _walls(rng: np.random.Generator, room: float, images: Images) -> list[MeshPart]:
    """Walls around the camera, some with a picture."""
    paper = covered(images, pattern(rng))
    high, turn = rng.uniform(*WALL_HEIGHT), rng.uniform(-0.6, 0.6)
    parts = []
    for number in range(4):
        if number and rng.random() < 0.15:
            continue
        yaw = turn + number * math.pi / 2
        away = room * (1.0 if number == 0 else rng.uniform(1.0, 1.6))
        at = (away * math.cos(yaw), away * math.sin(yaw), high / 2)
        material = paper if rng.random() < 0.7 else coloured(any_colour(rng))
        parts.append(box((0.1, 3.6 * room, high), at, material, (0, 0, yaw)))
        if rng.random() < 0.4:
            parts.append(_picture(rng, images, away, yaw, high))
    return parts


def _picture(rng, images: Images, away: float, yaw: float, high: float) -> MeshPart:
    picture = covered(images, pattern(rng))
    aside, size = rng.uniform(-1, 1) * away, rng.uniform(0.2, 0.9) * high
    on_wall = Pose.from_xyz_rpy((0, 0, 0), (0, 0, yaw))
    at = on_wall.transform((away - 0.06, aside, high * 0.5))
    return box((0.02, size * rng.uniform(0.6, 1.8), size), at, picture, (0, 0, yaw))


def _rgba(rgb: np.ndarray) -> tuple[float, float, float, float]:
    return (*(float(channel) for channel in rgb), 1.0)
