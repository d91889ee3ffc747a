"""What a camera sees by: its view and projection, and the frame that is drawn.

The optical axis meets the image at its centre: (width / 2, height / 2) if pixel edges are
integers, so pixel index ((width - 1) / 2, (height - 1) / 2). A point at (x, y, z) of the
camera frame (x forward, y left, z up) is at column (width - 1) / 2 - f y / x and at row
(height - 1) / 2 - f z / x, with f the focal length in pixels.
"""

import math
from collections.abc import Iterator
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


STRIP = 16  # rows of an image whose values fit into the processor's cache
# Camera frame (x forward, y left, z up) to OpenGL's eye frame (x right, y up, z backward).
_EYE_FROM_CAMERA = np.array([
    [0.0, -1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
])


def projection_matrix(view: CameraView) -> np.ndarray:
    """(4, 4) from OpenGL's eye frame to clip space, first image row at y = +1."""
    focal, near, far = view.focal_length_px, view.near, view.far
    return np.array([
        (2 * focal / view.width, 0.0, 0.0, 0.0),
        (0.0, 2 * focal / view.height, 0.0, 0.0),
        (0.0, 0.0, -(far + near) / (far - near), -2 * far * near / (far - near)),
        (0.0, 0.0, -1.0, 0.0),
    ])


def view_matrix(pose: Pose) -> np.ndarray:
    """(4, 4) from the world to OpenGL's eye frame of a camera at `pose`."""
    return _EYE_FROM_CAMERA @ pose.inverse().matrix()


def metres_from_depth(depth: np.ndarray, near: float, far: float) -> np.ndarray:
    """Depth buffer values 0..1 (h, w) as m along the optical axis, float32; inf where nothing was
    drawn.

    Uses 1 - depth, which is exact where depth is close to 1: no cancellation far away.
    """
    result = np.empty(depth.shape, np.float32)
    for rows in strips(len(depth)):
        part = np.subtract(np.float32(1), depth[rows], out=result[rows], dtype=np.float32)
        background = part <= 0
        part *= np.float32(1 / near - 1 / far)
        part += np.float32(1 / far)
        np.reciprocal(part, out=part)
        part[background] = np.inf
    return result


def strips(height: int) -> Iterator[slice]:
    """An image's rows, a few at a time, for several passes over each."""
    return (slice(top, top + STRIP) for top in range(0, height, STRIP))
