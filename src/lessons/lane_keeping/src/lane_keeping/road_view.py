"""Maps pixels of the region of interest to the ground: a pinhole camera over a flat road."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from lane_keeping.settings import Settings

FAR_AWAY = 1e6  # m; not infinity, which times 0 is not a number


@dataclass(frozen=True)
class RoadView:
    """A camera that looks down on the road, and the rows that are used.

    Pixels are (column, row) of the region of interest; the ground is (ahead, left) in m, from
    base_footprint.
    """

    width: int  # px
    height: int  # px, of the whole image
    top: int  # the first row of the region of interest
    focal: float  # px
    forward: float  # m
    lens_height: float  # m
    pitch: float  # rad, downwards positive
    lane_width: float  # m

    @property
    def rows(self) -> int:
        """Rows of the region of interest."""
        return self.height - self.top

    @property
    def horizon(self) -> float:
        """The image's row (not the region's) of the horizon."""
        return self.height / 2 - self.focal * math.tan(self.pitch)

    def to_ground(self, pixels: np.ndarray) -> np.ndarray:
        """(n, 2) pixels to (n, 2) m; FAR_AWAY at or above the horizon."""
        pixels = np.asarray(pixels, float)
        right = (pixels[..., 0] - self.width / 2) / self.focal
        down = (pixels[..., 1] + self.top - self.height / 2) / self.focal
        sinking = math.sin(self.pitch) + math.cos(self.pitch) * down
        along = math.cos(self.pitch) - math.sin(self.pitch) * down
        far = np.where(sinking > 1e-6, self.lens_height / np.maximum(sinking, 1e-6), FAR_AWAY)
        return np.stack([self.forward + far * along, -far * right], axis=-1)

    def to_pixels(self, ground: np.ndarray, above: float = 0.0) -> np.ndarray:
        """(n, 2) m to (n, 2) pixels, for points `above` m above the ground; NaN behind the lens."""
        ground = np.asarray(ground, float)
        ahead, drop = ground[..., 0] - self.forward, self.lens_height - above
        depth = ahead * math.cos(self.pitch) + drop * math.sin(self.pitch)
        depth = np.where(depth > 1e-3, depth, np.nan)
        down = (drop * math.cos(self.pitch) - ahead * math.sin(self.pitch)) / depth
        column = self.width / 2 - self.focal * ground[..., 1] / depth
        return np.stack([column, self.height / 2 + self.focal * down - self.top], axis=-1)

    def to_picture(self, ground: np.ndarray, above: float = 0.0) -> np.ndarray:
        """As to_pixels, in rows of the whole image."""
        return self.to_pixels(ground, above) + np.array([0, self.top])

    def lane_width_px(self, row: np.ndarray | float) -> np.ndarray | float:
        """The width in columns of a straight lane in this row of the region."""
        down = (np.asarray(row, float) + self.top - self.height / 2) / self.focal
        sinking = math.sin(self.pitch) + math.cos(self.pitch) * down
        return self.focal * self.lane_width * np.maximum(sinking, 0) / self.lens_height


def road_view(settings: Settings, width: int, height: int) -> RoadView:
    """The view of the settings' camera, for images of this size."""
    return RoadView(
        width=width,
        height=height,
        top=height - round(settings.roi_share * height),
        focal=width / 2 / math.tan(settings.camera_hfov / 2),
        forward=settings.camera_forward,
        lens_height=settings.camera_height,
        pitch=settings.camera_pitch,
        lane_width=settings.lane_width,
    )
