"""Props as the simulator loads them, and how large they are."""

import numpy as np

from bullet_sim.description import Box, Cylinder, Geometry, ModelDescription, Sphere
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources

RESOURCES = Resources.from_environment({})


def load(name: str) -> ModelDescription:
    return load_model('<sdf version="1.6"><world name="w"><include><pose>0 0 0 0 0 0</pose>'
                      f"<uri>model://{name}</uri></include></world></sdf>", RESOURCES)


def half_extent(shape: Geometry, turn: np.ndarray) -> np.ndarray:
    """(3,) m, half of what a turned shape measures along x, y and z."""
    match shape:
        case Sphere(radius):
            return np.full(3, radius)
        case Box(size):
            return np.abs(turn) @ (np.array(size) / 2)
        case Cylinder(radius, length):
            axis = turn[:, 2]
            return np.abs(axis) * length / 2 + radius * np.sqrt(np.maximum(1 - axis ** 2, 0))
    raise TypeError(shape)


def bounds(model: ModelDescription) -> tuple[np.ndarray, np.ndarray]:
    """(3,) m each: least and greatest corner of all that is solid, of all that is seen if none."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    solid = any(link.collisions for link in model.links)
    for link in model.links:
        for part in link.collisions if solid else link.visuals:
            place = (link.pose * part.pose).matrix()
            reach = half_extent(part.geometry, place[:3, :3])
            low = np.minimum(low, place[:3, 3] - reach)
            high = np.maximum(high, place[:3, 3] + reach)
    return low, high
