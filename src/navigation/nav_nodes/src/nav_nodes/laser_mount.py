"""How lasers are mounted on the robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from geometry_msgs.msg import Transform

from nav_nodes.missing_data import MissingData
from nav_nodes.transforms import Transforms

LEVEL = 0.02  # largest 1 - |cosine| of a laser's tilt: about 11 degrees


@dataclass(frozen=True)
class Mount:
    """`pose` (x, y, yaw) of the laser in the robot's frame; upside down, angles are reversed."""

    pose: np.ndarray
    upside_down: bool

    @classmethod
    def of(cls, transform: Transform) -> Mount:
        """From the laser's transform in the robot's frame; raises ValueError for a tilted one."""
        x, y, z, w = (getattr(transform.rotation, axis) for axis in "xyzw")
        up = 1.0 - 2.0 * (x * x + y * y)
        if not abs(up) > 1.0 - LEVEL:
            raise ValueError("the laser must look along the floor, but its transform tilts it")
        yaw = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        return cls(np.array([transform.translation.x, transform.translation.y, yaw]), up < 0.0)


class Mounts:
    """Mounts of all lasers of one robot; each is fixed, so it is looked up once."""

    def __init__(self, base: str, transforms: Transforms, missing_data: MissingData) -> None:
        """`base`: name of the robot's frame."""
        self._base, self._transforms, self._missing_data = base, transforms, missing_data
        self._known: dict[str, Mount] = {}

    def of(self, laser: str) -> Mount | None:
        """A laser's mount, by its frame's name; None, with a logged line, if unknown or tilted."""
        laser = laser.lstrip("/")
        if laser in self._known:
            return self._known[laser]
        found = self._transforms.find(self._base, laser)
        if found is None:
            return None
        what = f"level laser in frame {laser}"
        try:
            self._known[laser] = Mount.of(found)
        except ValueError as error:
            self._missing_data.missing(what, str(error))
            return None
        self._missing_data.present(what)
        return self._known[laser]
