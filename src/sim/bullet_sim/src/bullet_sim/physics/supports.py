"""What supports a robot: wheels on level axles, and as casters all else that its base holds.

On flat ground in the model's frame, joints at zero.
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bullet_sim.description import Box, Collision, Cylinder, Mesh, Sphere
from bullet_sim.errors import FormatError
from bullet_sim.meshes.loading import collision_mesh
from bullet_sim.physics.assembly import PhysicsLink, Tree
from bullet_sim.physics.tyres import CENTRED, ROLLING, find_tyre, rolls
from bullet_sim.pose import Pose, Vector3, rotate, rotation_matrix

FLAT = 0.1  # sine: an axle is about level, or a swivel about upright
LOWEST = 1e-4  # m: corners that are so little higher than the lowest one stand on the ground, too
TRAIL = 0.1  # radii that casters run behind their swivels, at least; steered wheels do not


@dataclass(frozen=True)
class Axle:
    """What a collision rolls on."""

    ahead: np.ndarray  # (3,) where it rolls to, in the model's frame; zeros: anywhere
    centre: Vector3  # m, in the link's frame
    radius: float  # m


@dataclass(frozen=True, eq=False)
class Support:
    """A collision that may touch the ground."""

    link: int
    place: int  # among the link's collisions
    collision: Collision
    pose: Pose  # of the collision
    feet: np.ndarray  # (n, 3) m, the lowest points
    axle: Axle | None = None  # of what rolls
    follows: bool = False  # whether the axle runs behind a swivel, or turns any way

    @property
    def bottom(self) -> float:
        """Its height, m."""
        return float(self.feet[:, 2].min())


def find_supports(tree: Tree) -> Iterator[Support]:
    """What the base holds, stiff, on a ball joint or a swivel, and what rolls on these.

    Steered wheels are left out.
    """
    frames: dict[str | None, Pose] = {None: Pose()}
    swivels: dict[str | None, Pose | None] = {None: None}  # of what is held, if it turns on one
    for number, link in enumerate(tree.links):
        frame = frames[link.name] = frames[link.parent] * link.pose_parent
        if link.parent not in swivels:
            continue
        swivel = swivels[link.parent]
        if link.joint is None or link.joint.type == "ball":
            swivels[link.name] = swivel
        elif swivel is None and _is_swivel(link, frame):
            swivels[link.name] = frame
        elif not _is_level(link, frame):
            continue
        for place, collision in enumerate(link.collisions):
            pose = frame * collision.pose
            feet = _feet(collision, pose)
            if feet is None:
                continue
            if link.name in swivels:
                ball = _ball(link, collision, feet, pose)
                yield Support(number, place, collision, pose, feet, ball, ball is not None)
                continue
            axle = _axle(link, collision, frame, feet)
            if axle is not None and (swivel is None or _trails(feet, axle, swivel)):
                yield Support(number, place, collision, pose, feet, axle, swivel is not None)


def _is_swivel(link: PhysicsLink, frame: Pose) -> bool:
    x, y, z = rotate(frame.orientation, link.joint.axis)
    return link.joint.type in ROLLING and math.hypot(x, y) < FLAT * abs(z)


def _is_level(link: PhysicsLink, frame: Pose) -> bool:
    x, y, z = rotate(frame.orientation, link.joint.axis)
    return link.joint.type in ROLLING and abs(z) < FLAT * math.hypot(x, y)


def _ball(link: PhysicsLink, collision: Collision, feet: np.ndarray, pose: Pose) -> Axle | None:
    """Of a ball, or what passes for one, that turns about its middle."""
    centre = collision.pose.position
    if (link.joint is None or link.joint.type != "ball" or math.hypot(*centre) > CENTRED
            or not isinstance(collision.geometry, Sphere | Mesh)):
        return None
    return Axle(np.zeros(3), centre, float(pose.position[2] - feet[:, 2].min()))


def _axle(link: PhysicsLink, collision: Collision, frame: Pose, feet: np.ndarray) -> Axle | None:
    """Of what turns about its middle on a level one."""
    if not rolls(link, collision) or not isinstance(collision.geometry, Cylinder | Sphere | Mesh):
        return None
    x, y, _ = rotate(frame.orientation, link.joint.axis)
    tyre = find_tyre(link, collision)
    centre = collision.pose.position if tyre is None else tyre.middle.position
    height = frame.transform(centre)[2] - feet[:, 2].min()
    return Axle(np.array((y, -x, 0.0)) / math.hypot(x, y), centre, float(height))


def _trails(feet: np.ndarray, axle: Axle, swivel: Pose) -> bool:
    behind = (feet.mean(axis=0) - swivel.position) @ axle.ahead
    return abs(behind) > TRAIL * axle.radius


def _feet(collision: Collision, pose: Pose) -> np.ndarray | None:
    """The lowest points of a shape, (n, 3); None for what is neither wheel nor caster."""
    turn = rotation_matrix(pose.orientation)
    match collision.geometry:
        case Sphere(radius):
            return pose.position - np.array([(0.0, 0.0, radius)])
        case Cylinder(radius, length):
            x, y, z = turn[2]
            reach = 0.5 * abs(z) * length + math.hypot(x, y) * radius
            return pose.position - np.array([(0.0, 0.0, reach)])
        case Box(size):
            corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * size
        case Mesh():
            try:
                corners = collision_mesh(collision.geometry)[0]
            except FormatError:  # reported where the shape is made
                return None
        case _:
            return None
    points = corners @ turn.T + pose.position
    return points[points[:, 2] < points[:, 2].min() + LOWEST]
