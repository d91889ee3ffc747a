"""Images wider than a pinhole's: the faces of a cube, mapped through a lens function.

A point at the angle theta from the optical axis is seen at r = c1 f fun(theta / c2 + c3) from the
centre of the image, where r is 1 at half the image's width: SDF's `<lens>`.
"""

import math
from collections.abc import Callable

import cv2
import numpy as np

from bullet_sim.description import CameraDescription
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView

SMALLEST_PX = 8  # side of a cube's face
_MARGIN_PX = 1  # around a face, so that neighbours meet without a seam
_BEYOND = 0.2  # brightness beyond <cutoff_angle>
_OUTSIDE = -2.0  # px; a position that shows nothing
_FACES = [  # the camera's rotations for looking straight at them
    Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, pitch, yaw)) for pitch, yaw in (
        (0.0, 0.0), (0.0, math.pi / 2), (0.0, -math.pi / 2), (-math.pi / 2, 0.0),
        (math.pi / 2, 0.0), (0.0, math.pi))
]
_FUNCTION = {"sin": math.sin, "tan": math.tan, "id": float}
_INVERSE = {"sin": np.arcsin, "tan": np.arctan, "id": np.asarray}


class WideLens:
    """The image of a wide-angle camera, made from up to six square images of 90 degrees."""

    def __init__(self, camera: CameraDescription):
        self._camera = camera
        side = camera.lens.env_texture_size
        focal_px = side / 2 - _MARGIN_PX
        self._face_fov = 2 * math.atan(side / 2 / focal_px)
        theta, towards = self._directions()
        self._faces, source = _places_on_faces(towards, side, focal_px)
        source[~(theta <= math.pi)] = _OUTSIDE
        self._maps = cv2.convertMaps(source.astype(np.float32), None, cv2.CV_16SC2)
        self._beyond = (theta > camera.lens.cutoff_angle).astype(np.uint8)

    def draw(self, camera: Pose, draw_view: Callable[[CameraView], np.ndarray]) -> np.ndarray:
        """The image (h, w, 3) uint8; `draw_view` draws a pinhole's, `camera` is a world pose."""
        side = self._camera.lens.env_texture_size
        strip = np.concatenate([
            draw_view(CameraView(side, side, self._face_fov, self._camera.near, self._camera.far,
                                 camera * face)) for face in self._faces])
        rgb = cv2.remap(strip, *self._maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
        return cv2.copyTo(cv2.convertScaleAbs(rgb, alpha=_BEYOND), self._beyond, rgb)

    def _directions(self) -> tuple[np.ndarray, np.ndarray]:
        """Angle from the axis (h, w), NaN where the lens shows nothing, and unit vectors."""
        width, height, lens = self._camera.width, self._camera.height, self._camera.lens
        right = (np.arange(width) - (width - 1) / 2) / (width / 2)
        down = (np.arange(height) - (height - 1) / 2) / (width / 2)
        right, down = np.meshgrid(right, down)
        radius = np.maximum(np.hypot(right, down), 1e-9)
        with np.errstate(invalid="ignore"):
            theta = _INVERSE[lens.function](radius / (lens.c1 * self._f()))
        theta = (theta - lens.c3) * lens.c2
        sine = np.sin(theta) / radius
        return theta, np.stack([np.cos(theta), -sine * right, -sine * down], axis=-1)

    def _f(self) -> float:
        lens = self._camera.lens
        if not lens.scale_to_hfov:
            return lens.f
        edge = _FUNCTION[lens.function](self._camera.horizontal_fov / 2 / lens.c2 + lens.c3)
        return 1 / (lens.c1 * edge)


def mistake_in_lens(camera: CameraDescription, largest_px: int) -> str | None:
    """Why a renderer of images up to `largest_px` cannot draw such a camera; None if it can."""
    lens = camera.lens
    if not 0 < camera.horizontal_fov <= 2 * math.pi:
        return f"<horizontal_fov> is {camera.horizontal_fov}, which is not between 0 and 2 pi"
    if not SMALLEST_PX <= lens.env_texture_size <= largest_px:
        return (f"<env_texture_size> is {lens.env_texture_size}, which is not between "
                f"{SMALLEST_PX} and {largest_px} px")
    if 0.0 in (lens.c1, lens.c2) or (not lens.scale_to_hfov and lens.f == 0.0):
        return "<c1>, <c2> and <f> of a lens cannot be 0"
    half = camera.horizontal_fov / 2 / lens.c2 + lens.c3
    if lens.scale_to_hfov and lens.function != "id" and not 0 < half < math.pi / 2 + 1e-3:
        return (f"<horizontal_fov> is {camera.horizontal_fov}, more than this <lens> can show; "
                "lenses of type equidistant show any angle")
    return None


def _places_on_faces(towards: np.ndarray, side: int,
                     focal_px: float) -> tuple[list[Pose], np.ndarray]:
    """The faces that are seen, and for each pixel its place (h, w, 2) in a strip of their images.

    In the strip they are one below the other.
    """
    axes = np.array([face.matrix()[:3, 0] for face in _FACES])
    nearest = np.argmax(np.nan_to_num(towards) @ axes.T, axis=-1)
    middle = (side - 1) / 2
    faces, places = [], np.full((*nearest.shape, 2), _OUTSIDE)
    for index, face in enumerate(_FACES):
        here = nearest == index
        if not here.any():
            continue
        forward, left, up = (towards[here] @ face.matrix()[:3, :3]).T
        with np.errstate(invalid="ignore"):
            places[here] = np.stack([middle - focal_px * left / forward,
                                     middle - focal_px * up / forward + len(faces) * side], axis=1)
        faces.append(face)
    return faces, places
