"""A renderer's input and output."""

import math
from dataclasses import dataclass

import numpy as np

from bullet_sim.pose import Pose

LARGEST_PX = 8192  # longest side of an image
LARGEST_SQUARE_PX = 4096  # side of the largest square one: more takes seconds to draw and send


def drawable_size(width: int, height: int, largest_px: int) -> tuple[int, int]:
    """The size in px, of the same shape, that can be drawn; `largest_px` is a renderer's limit."""
    most = LARGEST_SQUARE_PX ** 2
    shrink = min(1.0, largest_px / max(width, height), math.sqrt(most / (width * height)))
    return max(1, int(width * shrink)), max(1, int(height * shrink))


@dataclass(frozen=True)
class CameraView:
    """A pinhole camera that looks along +x of its frame, z up (SDF's convention)."""

    width: int  # px
    height: int  # px
    horizontal_fov: float  # rad
    near: float  # m
    far: float  # m
    pose: Pose  # camera frame in the world

    @property
    def focal_length_px(self) -> float:
        """Focal length of both axes: width / (2 tan(hfov / 2)); pixels are square."""
        return self.width / (2 * math.tan(self.horizontal_fov / 2))


@dataclass(frozen=True)
class Frame:
    """One image, top row first."""

    rgb: np.ndarray  # (height, width, 3) uint8, RGB, C-contiguous
    depth: np.ndarray | None  # (height, width) float32, m along the optical axis; inf beyond far
