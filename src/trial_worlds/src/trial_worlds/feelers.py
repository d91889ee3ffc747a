"""A robot's distance to obstacles, by rays from the sides of its collision shapes.

The rays are cast in a second world, from the same file, so that they cost the simulator nothing.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

import cv2
import numpy as np
import rospkg

from bullet_sim.description import Box, Collision, Cylinder, Geometry, Sphere
from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.world import World
from trial_worlds.errors import WorldError

SPACING = 0.01  # m, from ray to ray along a side; no table leg fits between two
INSIDE = 0.02   # m behind the surface, where rays begin: bodies in contact penetrate a little
REACH = 0.5     # m in front of it
FAN = 0.12      # rad, from ray to ray about a corner
ROUND = 24      # corners of a circle


@dataclass(frozen=True)
class Gap:
    """The smallest distance from the robot to another object; REACH if nothing is that near."""

    width: float  # m
    own: str  # the robot's collision element
    place: tuple[float, float]  # m, in the world, of the other object


class Feelers:
    """Rays around the shapes of a robot that stands upright on the ground."""

    def __init__(self, world: World, urdf: str):
        """Raises WorldError if the text describes no robot."""
        self._world = world
        starts, ways, self._names = [], [], []
        for name, collision, link in _collisions(urdf):
            points, normals, height = _sides(collision, link)
            starts.append(np.column_stack((points - INSIDE * normals,
                                           np.full(len(points), height))))
            ways.append(np.column_stack((normals, np.zeros(len(points)))))
            self._names += [name] * len(points)
        self._starts, self._ways = np.concatenate(starts), np.concatenate(ways)

    def gap(self, pose: np.ndarray) -> Gap:
        """The gap of a robot at this pose (3,) in the world."""
        x, y, yaw = pose
        turn = np.array([[np.cos(yaw), np.sin(yaw), 0], [-np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
        starts = self._starts @ turn + (x, y, 0.0)
        ways = self._ways @ turn * (INSIDE + REACH)
        fractions = self._world.cast_rays(starts, starts + ways).fraction
        nearest = int(np.argmin(fractions))
        place = (starts + fractions[:, None] * ways)[nearest, :2]
        return Gap(float(fractions[nearest] * (INSIDE + REACH) - INSIDE), self._names[nearest],
                   (round(float(place[0]), 3), round(float(place[1]), 3)))


def _collisions(urdf: str) -> list[tuple[str, Collision, Pose]]:
    """Name, collision and link pose in the robot, of each shape that has sides."""
    resources = Resources.from_environment(os.environ, find_package=rospkg.RosPack().get_path)
    try:
        model = load_model(urdf, resources)
    except SimulationError as error:
        raise WorldError(f"parameter robot_description: {error}") from error
    found = [(each.name, each, link.pose) for link in model.links for each in link.collisions
             if isinstance(each.geometry, Box | Cylinder | Sphere)]
    if not found:
        raise WorldError("parameter robot_description: no box, cylinder or sphere to feel with")
    return found


def _sides(collision: Collision, link: Pose) -> tuple[np.ndarray, np.ndarray, float]:
    """Points (N, 2), m, on the outline as seen from above, normals (N, 2), and a height, m."""
    pose = link * collision.pose
    points = np.array([pose.transform(point) for point in _corners(collision.geometry)])
    corners = cv2.convexHull(points[:, :2].astype(np.float32))[:, 0].astype(float)
    if np.cross(corners[1] - corners[0], corners[2] - corners[1]) < 0:
        corners = corners[::-1]  # counter-clockwise
    sides = np.roll(corners, -1, axis=0) - corners
    long = np.linalg.norm(sides, axis=1)
    angles = np.arctan2(-sides[:, 0], sides[:, 1])  # of the outward normals
    places, directions = [], []
    for k, corner in enumerate(corners):
        shares = np.linspace(0.0, 1.0, max(2, int(np.ceil(long[k] / SPACING)) + 1))
        places += [corner + share * sides[k] for share in shares]
        directions += [angles[k]] * len(shares)
        bend = (angles[k] - angles[k - 1]) % (2 * np.pi)
        turns = np.linspace(0.0, bend, int(np.ceil(bend / FAN)) + 1)
        places += [corner] * len(turns)
        directions += (angles[k - 1] + turns).tolist()
    return (np.array(places), np.stack((np.cos(directions), np.sin(directions)), axis=1),
            pose.position[2])


def _corners(geometry: Geometry) -> np.ndarray:
    """Points (N, 3), m, whose convex hull is the shape, at least nearly."""
    signs = np.array(np.meshgrid(*3 * [(-1.0, 1.0)])).reshape(3, -1).T
    around = np.linspace(0.0, 2 * np.pi, ROUND, endpoint=False)
    circle = np.stack((np.cos(around), np.sin(around), np.zeros(ROUND)), axis=1)
    match geometry:
        case Box(size):
            return signs * np.array(size) / 2
        case Cylinder(radius, length):
            end = np.array([0.0, 0.0, length / 2])
            return np.concatenate((radius * circle + end, radius * circle - end))
        case Sphere(radius):
            return radius * circle
    raise AssertionError(f"no sides of {geometry}")
