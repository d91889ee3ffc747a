"""The supports of a robot: wheels on level axles, and as casters everything else on its base.

On flat ground in the model's frame, with joints at zero.
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

FLAT = 0.1  # sine: an axle counts as level, or a swivel as upright
LOWEST = 1e-4  # m: corners this little higher than the lowest one stand on the ground, too
# (8, 3) points of a unit circle on the ground: the bottom of a cylinder that stands upright
RIM = np.array([(math.cos(turn), math.sin(turn), 0.0) for turn in np.arange(8) * math.pi / 4])
TRAIL = 0.1  # minimum trail of casters behind their swivels, in radii; steered wheels have less


@dataclass(frozen=True)
class Axle:
    """How a collision rolls."""

    ahead: np.ndarray  # (3,) rolling direction, in the model's frame; zeros: any
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
    axle: Axle | None = None  # if it rolls
    follows: bool = False  # whether the axle trails a swivel, or turns in any direction

    @property
    def bottom(self) -> float:
        """Height of the lowest point, m."""
        return float(self.feet[:, 2].min())


def find_supports(tree: Tree) -> Iterator[Support]:
    """Shapes on the base, rigid, on a ball joint or a swivel, and those that roll on these.

    Steered wheels are left out.
    """
    frames: dict[str | None, Pose] = {None: Pose()}
    swivels: dict[str | None, Pose | None] = {None: None}  # of the links found, if they turn on one
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
    """Axle of a ball, or of a similar mesh, that turns about its centre."""
    centre = collision.pose.position
    if (link.joint is None or link.joint.type != "ball" or math.hypot(*centre) > CENTRED
            or not isinstance(collision.geometry, Sphere | Mesh)):
        return None
    return Axle(np.zeros(3), centre, float(pose.position[2] - feet[:, 2].min()))


def _axle(link: PhysicsLink, collision: Collision, frame: Pose, feet: np.ndarray) -> Axle | None:
    """Axle of a shape that turns about a level axis through its centre."""
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
    """The lowest points of a shape, (n, 3); None if it is neither wheel nor caster."""
    turn = rotation_matrix(pose.orientation)
    match collision.geometry:
        case Sphere(radius):
            return pose.position - np.array([(0.0, 0.0, radius)])
        case Cylinder(radius, length):
            x, y, z = turn[2]
            reach = 0.5 * abs(z) * length + math.hypot(x, y) * radius
            lowest = pose.position - np.array([(0.0, 0.0, reach)])
            stands = 2 * math.hypot(x, y) * radius < LOWEST
            return lowest + radius * RIM if stands else lowest
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
