"""The pinhole camera as matrices.

The optical axis meets the image at its centre: (width / 2, height / 2) if pixel edges are
integers, so pixel index ((width - 1) / 2, (height - 1) / 2). A point at (x, y, z) of the
camera frame (x forward, y left, z up) is at column (width - 1) / 2 - f y / x and at row
(height - 1) / 2 - f z / x, with f the focal length in pixels.
"""

from collections.abc import Iterator

import numpy as np

from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView

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
    matrix = np.zeros((4, 4))
    matrix[0, 0] = 2 * focal / view.width
    matrix[1, 1] = 2 * focal / view.height
    matrix[2, 2] = -(far + near) / (far - near)
    matrix[2, 3] = -2 * far * near / (far - near)
    matrix[3, 2] = -1.0
    return matrix


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
