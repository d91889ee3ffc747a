"""Masses and inertias that the engine can use: those in files may be impossible.

The engine does not turn a link at all if its principal moments violate the triangle inequality
(each at most the sum of the others), and lets it fall through the ground if they are far too
small for its size: contacts then turn it round within a step.
"""

import logging
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bullet_sim.description import Box, Collision, Cylinder, Geometry, Inertial, Plane, Sphere
from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.meshes.loading import collision_mesh
from bullet_sim.pose import symmetric_matrix

log = logging.getLogger(__name__)

THINNEST = 0.01  # minimum radius of gyration relative to the size; half of it falls through
SMALLEST = 1e-4  # m, the size of a link without shape
HEAVIEST = 1e12  # kg
LIGHTEST = 1e-9  # kg
ROUNDING = 1e-6


def check_inertial(inertial: Inertial) -> None:
    """SimulationError if the numbers are invalid, or no tensor of inertia.

    A violation of only the triangle inequality passes: `sound_inertial` corrects it.
    """
    values = (inertial.mass, *inertial.inertia, *inertial.pose.position)
    if not all(map(math.isfinite, values)) or inertial.mass <= 0:
        raise SimulationError("mass must be above 0, and mass, centre of mass and inertia finite")
    moments = np.linalg.eigvalsh(symmetric_matrix(inertial.inertia))
    if moments[0] <= 0:
        raise SimulationError(
            f"this is not an inertia: its principal moments would be "
            f"{', '.join(f'{m:.3g}' for m in moments)} kg m^2, and all have to be above 0; ixy, "
            "ixz and iyz are too large for ixx, iyy and izz")


def sound_inertial(inertial: Inertial, collisions: Sequence[Collision], where: str) -> Inertial:
    """The same if it is possible; else with the lowest possible moments, and a line in the log.
    """
    mass = min(max(inertial.mass, LIGHTEST), HEAVIEST)
    moments, axes = np.linalg.eigh(symmetric_matrix(inertial.inertia))
    least = mass * (THINNEST * max(_size(collisions), SMALLEST)) ** 2
    sound = _possible(moments, least)
    if mass == inertial.mass and np.allclose(sound, moments, rtol=ROUNDING, atol=0.0):
        return inertial
    log.info("%s: no body of %g kg has principal moments of inertia of %s kg m^2; %s are taken",
             where, inertial.mass, *(", ".join(f"{m:.3g}" for m in row)
                                     for row in (moments, sound)))
    fixed = axes @ np.diag(sound) @ axes.T
    return replace(inertial, mass=mass, inertia=tuple(
        float(fixed[i, j]) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))))


def _possible(moments: np.ndarray, least: float) -> np.ndarray:
    """Three moments, rising, at least `least`, the lower two raised to the triangle inequality."""
    low, middle, high = np.maximum(moments, least)
    missing = high * (1.0 + ROUNDING) - (low + middle)
    if missing <= 0.0:
        return np.array([low, middle, high])
    low = min(middle, low + missing)
    share = max(0.0, high * (1.0 + ROUNDING) - (low + middle)) / 2
    return np.array([low + share, middle + share, high])


def _size(collisions: Sequence[Collision]) -> float:
    """Half the extent of the largest collision, m."""
    return max((_reach(collision.geometry) for collision in collisions), default=0.0)


def _reach(geometry: Geometry) -> float:
    match geometry:
        case Sphere(radius):
            return radius
        case Box(size):
            return math.hypot(*size) / 2
        case Cylinder(radius, length):
            return math.hypot(radius, length / 2)
        case Plane():
            return 0.0
    try:
        vertices, _ = collision_mesh(geometry)
    except FormatError:  # reported where the shape is made
        return 0.0
    return float(np.linalg.norm(np.ptp(vertices, axis=0))) / 2 if len(vertices) else 0.0
