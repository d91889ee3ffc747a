"""The course's picture worked out ray by ray: what a perfect renderer would give.

A ray through the middle of each pixel is cut with the floor's planes; the texture there is lit as
Gazebo lights it: emissive + ambient x the scene's ambient + the sum over directional lights of
diffuse x diffuse x cosine, at most 1, times the texture. Pixels with an edge near them, which would
have to be averaged, are not compared. Highlights, which are less than half a grey level on these
floors, and the robot, which its camera does not see, are left out. Nothing here is shared with the
renderer but the description of the world.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from bullet_sim.description import Plane, WorldDescription
from bullet_sim.pose import Pose, rotate
from bullet_sim.rendering.frame import CameraView

# A trilinear texture filter reaches three of the pixel's longest sides on the floor to every side:
# its coarser level has texels of up to two sides, and takes in one and a half of them.
FILTER_REACH = 3.0
EDGE_STEP = 2  # grey levels between neighbouring texels that make an edge


@dataclass(frozen=True)
class FloorPlane:
    """A horizontal rectangle, centred at `pose`, seen from above."""

    pose: Pose
    size: tuple[float, float]  # m
    light: np.ndarray  # (3,) RGB, what the texture or white is multiplied with, 0..1
    texture: np.ndarray | None  # (height, width, 3) float32 RGB 0..255, first row at +y
    edge_distance: np.ndarray | None  # (height, width) float32 m, of a texel from an edge in it

    def local(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points of the world's floor in the plane's own axes, m."""
        yaw = self.pose.rpy()[2]
        dx, dy = x - self.pose.position[0], y - self.pose.position[1]
        return np.cos(yaw) * dx + np.sin(yaw) * dy, np.cos(yaw) * dy - np.sin(yaw) * dx

    def look_up(self, image: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """A picture of the plane, bilinearly, at points of the plane (2-D arrays)."""
        height, width = image.shape[:2]
        columns = (u / self.size[0] + 0.5) * width - 0.5
        rows = (0.5 - v / self.size[1]) * height - 0.5
        columns, rows = columns.astype(np.float32), rows.astype(np.float32)
        return cv2.remap(image, columns, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


@dataclass(frozen=True)
class AnalyticPicture:
    """The picture, and how far from any edge each pixel is."""

    rgb: np.ndarray  # (height, width, 3) float32, 0..255
    clear: np.ndarray  # (height, width) bool: no edge within the reach of a texture filter


def floor_planes(description: WorldDescription) -> list[FloorPlane]:
    """The planes of a world's static models, the smallest first: it lies on top."""
    planes = []
    for model in description.models:
        for link in model.links:
            for visual in link.visuals:
                if isinstance(visual.geometry, Plane):
                    pose = model.pose * link.pose * visual.pose
                    planes.append(_floor_plane(description, pose, visual))
    return sorted(planes, key=lambda plane: max(plane.size))


def render(description: WorldDescription, view: CameraView) -> AnalyticPicture:
    """The floor and the background as a camera above it sees them.

    Clear is a pixel with no edge, of a texture or of a plane, within a filter's reach, and not
    within two of where the floor's first pixel is.
    """
    size, centres = _pixel_size(view), np.indices((view.height, view.width)) + 0.5
    x, y, met = floor_points(view, centres[1], centres[0])
    rgb = np.full((*x.shape, 3), 255 * np.array(description.scene.background[:3]), np.float32)
    nearest, free = np.full(x.shape, np.inf), met
    for plane in floor_planes(description):
        u, v = plane.local(x, y)
        outside = np.maximum(np.abs(u) - plane.size[0] / 2, np.abs(v) - plane.size[1] / 2)
        nearest = np.minimum(nearest, np.abs(outside))
        here = free & (outside <= 0)
        seen = 255.0
        if plane.texture is not None:
            seen = plane.look_up(plane.texture, u, v)[here]
            distance = plane.look_up(plane.edge_distance, u, v)
            nearest = np.where(outside <= 0, np.minimum(nearest, distance), nearest)
        rgb[here] = seen * plane.light
        free = free & ~here
    sky = ~met & ~np.isfinite(size)
    with np.errstate(invalid="ignore"):
        clear = sky | (nearest > FILTER_REACH * size)
    floor, around = met.astype(np.uint8), np.ones((5, 5), np.uint8)
    return AnalyticPicture(rgb, clear & (cv2.dilate(floor, around) == cv2.erode(floor, around)))


def difference(picture: np.ndarray, analytic: AnalyticPicture) -> np.ndarray:
    """Grey levels, the worst channel of each pixel: (height, width) float32."""
    return np.abs(picture.astype(np.float32) - analytic.rgb).max(axis=2)


def floor_points(
    view: CameraView, columns: np.ndarray, rows: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, y (m) where rays through picture points meet z = 0, and whether they do.

    Pixel edges are whole numbers; a point counts if it lies between the near and far planes.
    """
    focal = view.focal_length_px
    left = (view.width / 2 - columns) / focal
    up = (view.height / 2 - rows) / focal
    turn = view.pose.matrix()[:3, :3]
    ray = [turn[i, 0] + turn[i, 1] * left + turn[i, 2] * up for i in range(3)]
    eye = view.pose.position
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = np.where(ray[2] < 0, -eye[2] / ray[2], np.inf)
        met = (depth >= view.near) & (depth <= view.far)
        depth = np.where(met, depth, 0.0)
    return eye[0] + depth * ray[0], eye[1] + depth * ray[1], met


def _floor_plane(description: WorldDescription, pose: Pose, visual: object) -> FloorPlane:
    material, texture, edges = visual.material, None, None
    size = visual.geometry.size
    if material.texture is not None:
        texture = cv2.cvtColor(cv2.imread(material.texture), cv2.COLOR_BGR2RGB).astype(np.float32)
        edges = _edge_distance(texture, max(size) / max(texture.shape))
    light = np.array(material.emissive[:3], np.float32)
    light = light + np.multiply(material.ambient[:3], description.scene.ambient[:3])
    for source in description.lights:
        if source.type == "directional":
            direction = np.array(rotate(source.pose.orientation, source.direction))
            cosine = max(0.0, -direction[2] / np.linalg.norm(direction))
            light = light + cosine * np.multiply(material.diffuse[:3], source.diffuse[:3])
    return FloorPlane(pose, size, np.minimum(light, 1.0).astype(np.float32), texture, edges)


def _edge_distance(texture: np.ndarray, metres_per_texel: float) -> np.ndarray:
    """How far (m) each texel is from the next one that differs from a neighbour."""
    cross = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
    far = np.maximum(cv2.dilate(texture, cross) - texture, texture - cv2.erode(texture, cross))
    step = far.max(axis=2) > EDGE_STEP
    return cv2.distanceTransform((~step).astype(np.uint8), cv2.DIST_L2, 5) * metres_per_texel


def _pixel_size(view: CameraView) -> np.ndarray:
    """(height, width): the longest side (m) that each pixel has on the floor; inf in the sky."""
    corners = np.meshgrid(np.arange(view.width + 1.0), np.arange(view.height + 1.0))
    x, y, met = floor_points(view, *corners)
    along = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0))
    across = np.hypot(np.diff(x[:-1], axis=1), np.diff(y[:-1], axis=1))
    longest = np.maximum(np.maximum(along[:, 1:], along[:, :-1]), across)
    met = met[:-1] & met[1:]
    return np.where(met[:, 1:] & met[:, :-1], longest, np.inf)
