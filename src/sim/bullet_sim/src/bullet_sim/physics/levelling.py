"""Lets casters be a little lower than the wheels, as ODE's surface layer does.

ODE lets contacts be that are no deeper than the layer, so that casters which are up to 1 mm too
low do not lift the wheels. The engine's contacts push from the first: casters before and behind the
wheels would carry the robot, and these spin. Hence the casters' shapes are put up a little.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from bullet_sim.description import Box, Collision, Cylinder, Mesh, Sphere
from bullet_sim.errors import FormatError
from bullet_sim.meshes import collision_mesh
from bullet_sim.physics.assembly import PhysicsLink, Tree
from bullet_sim.physics.tyres import rolls
from bullet_sim.pose import Pose, Vector3, conjugate, rotate, rotation_matrix

THICKEST = 1e-3  # m; of a thicker layer no more than this counts
CLEARANCE = 2e-4  # m, of levelled casters above the wheels' ground: wheels sink in by less
ROUNDING = 1e-6  # m
FLAT = 0.1  # sine: an axle is about horizontal
GRIP = 0.5  # part of the greatest friction of all that rolls: what has less is a caster


@dataclass(frozen=True)
class _Support:
    """A collision as it stands on flat ground in the model's frame, joints at zero."""

    link: int
    place: int  # among the link's collisions
    collision: Collision
    pose: Pose
    bottom: float  # m
    axle: Vector3 | None  # of what rolls


def levelled(tree: Tree, layer: float) -> Tree:
    """The tree, no caster being lower than the wheels by up to `layer` (m).

    Only where casters before and behind the wheels would carry instead of them.
    """
    supports = [] if tree.fixed else list(_supports(tree))
    rolling = [support for support in supports if support.axle]
    grip = max((support.collision.surface.mu for support in rolling), default=0.0)
    wheels = [support for support in rolling if support.collision.surface.mu > GRIP * grip]
    if not wheels:
        return tree
    ground = min(wheel.bottom for wheel in wheels)
    casters = [support for support in supports
               if support not in wheels and _near(support, ground, layer)]
    if not _lifted(wheels, casters):
        return tree
    links = list(tree.links)
    for caster in casters:
        links[caster.link] = _raised(links[caster.link], caster, ground + CLEARANCE)
    return replace(tree, links=links)


def _near(support: _Support, ground: float, layer: float) -> bool:
    """Whether it is no lower than the wheels by more than is let be, and hardly higher."""
    deepest = min(max(layer, support.collision.surface.min_depth), THICKEST)
    return ground - deepest - ROUNDING < support.bottom < ground + CLEARANCE


def _lifted(wheels: list[_Support], casters: list[_Support]) -> bool:
    """Whether there are casters before all wheels and behind them."""
    axle = wheels[0].axle

    def way(support: _Support) -> float:
        x, y, _ = support.pose.position
        return x * axle[1] - y * axle[0]

    ways = [way(wheel) for wheel in wheels]
    return (any(way(caster) > max(ways) for caster in casters)
            and any(way(caster) < min(ways) for caster in casters))


def _raised(link: PhysicsLink, caster: _Support, bottom: float) -> PhysicsLink:
    """The link with that caster's bottom at another height (m); what rolls gets smaller."""
    height, shape = bottom - caster.bottom, caster.collision.geometry
    if caster.axle:
        changed = replace(caster.collision, geometry=replace(shape, radius=shape.radius - height))
    else:
        turn = conjugate(caster.pose.orientation)
        up = rotate(turn, (0.0, 0.0, height))
        changed = replace(caster.collision, pose=caster.collision.pose * Pose(up))
    collisions = list(link.collisions)
    collisions[caster.place] = changed
    return replace(link, collisions=collisions)


def _supports(tree: Tree) -> Iterator[_Support]:
    """What the base holds, stiff or on a ball joint, and what rolls on a horizontal axle of it."""
    frames: dict[str | None, Pose] = {None: Pose()}
    held: set[str | None] = {None}
    for number, link in enumerate(tree.links):
        frame = frames[link.name] = frames[link.parent] * link.pose_parent
        steady = link.joint is None or link.joint.type in ("ball", "fixed")
        if link.parent not in held:
            continue
        if steady:
            held.add(link.name)
        for place, collision in enumerate(link.collisions):
            axle = None
            if not steady:
                axle = _axle(link, collision, frame)
                if axle is None:
                    continue
            pose = frame * collision.pose
            reach = _reach_down(collision, pose)
            if reach is not None:
                yield _Support(number, place, collision, pose, pose.position[2] - reach, axle)


def _axle(link: PhysicsLink, collision: Collision, frame: Pose) -> Vector3 | None:
    """Direction of the horizontal axle that a collision turns on, in the model's frame."""
    if not rolls(link, collision) or not isinstance(collision.geometry, Cylinder | Sphere | Mesh):
        return None
    axle = rotate(frame.orientation, link.joint.axis)
    return axle if abs(axle[2]) < FLAT * math.hypot(*axle) else None


def _reach_down(collision: Collision, pose: Pose) -> float | None:
    """How far below its frame's origin it reaches, m; None for what is no caster."""
    down = rotation_matrix(pose.orientation)[2]
    match collision.geometry:
        case Sphere(radius):
            return radius
        case Box(size):
            return 0.5 * sum(abs(part) * edge for part, edge in zip(down, size, strict=True))
        case Cylinder(radius, length):
            return 0.5 * abs(down[2]) * length + math.hypot(down[0], down[1]) * radius
        case Mesh():
            try:
                return -float((collision_mesh(collision.geometry)[0] @ down).min())
            except FormatError:  # told where the shape is made
                return None
    return None
