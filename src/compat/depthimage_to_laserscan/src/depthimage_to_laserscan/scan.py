"""Some rows of a depth image as one laser scan.

The laser lies in the camera's x-z plane: range is the distance from the optical axis' origin, the
angle counts to the left (REP 103), so that the last range belongs to the image's left edge.
"""

from dataclasses import dataclass

import numpy as np

MILLIMETRES = 0.001  # m, unit of an image of 16 bit integers (REP 118)
ROUNDING = 1e-6  # of a step, so that the edge column falls into the edge range


@dataclass(frozen=True)
class Pinhole:
    """Of a rectified image, all in pixels: focal length, principal point, width and height."""

    focal: float
    center_x: float
    center_y: float
    width: int
    height: int


@dataclass(frozen=True)
class Angles:
    """Of a scan, in rad: first, last, between two; and how many ranges there are."""

    first: float
    last: float
    step: float
    count: int


class BadDepth(ValueError):
    """The image, its camera and the parameters do not fit together."""


def scan_angles(camera: Pinhole) -> Angles:
    """One range for each column; the outermost are the image's edges."""
    if camera.focal <= 0.0 or camera.width < 2:
        raise BadDepth(f"camera_info says focal length {camera.focal:g} and width {camera.width}; "
                       "it needs a focal length above 0 and at least 2 columns")
    last = np.arctan2(camera.center_x, camera.focal)
    first = -np.arctan2(camera.width - 1 - camera.center_x, camera.focal)
    return Angles(float(first), float(last), float(last - first) / (camera.width - 1), camera.width)


def rows_of(camera: Pinhole, scan_height: int) -> slice:
    """The `scan_height` rows around the optical axis."""
    first = int(camera.center_y - scan_height // 2)  # as upstream, in whole rows
    if scan_height < 1 or first < 0 or first + scan_height > camera.height:
        raise BadDepth(f"scan_height {scan_height} does not fit an image of {camera.height} rows "
                       f"whose optical axis is at row {camera.center_y:g}")
    return slice(first, first + scan_height)


def scan_ranges(depth: np.ndarray, camera: Pinhole, scan_height: int, range_min: float,
                range_max: float) -> np.ndarray:
    """Ranges in m, float32 (width,): NaN where nothing was seen, the nearest where several were.

    depth: (height, width), uint16 in mm (0: not known) or float32 in m (NaN or inf: not known).
    """
    angles = scan_angles(camera)
    rows = depth[rows_of(camera, scan_height)]
    metres = rows * MILLIMETRES if rows.dtype == np.uint16 else rows.astype(float)
    if rows.dtype == np.uint16:
        metres[rows == 0] = np.nan
    slope = (np.arange(camera.width) - camera.center_x) / camera.focal
    distances = metres * np.hypot(1.0, slope)
    with np.errstate(invalid="ignore"):
        usable = (distances >= range_min) & (distances <= range_max)
    columns = np.where(usable, distances, np.inf).min(axis=0)
    beyond = np.isposinf(distances).any(axis=0) & np.isinf(columns)
    index = ((-np.arctan(slope) - angles.first) / angles.step + ROUNDING).astype(int)
    ranges = np.full(angles.count, np.inf)
    np.minimum.at(ranges, index.clip(0, angles.count - 1), columns)
    seen_far = np.zeros(angles.count, dtype=bool)
    seen_far[index.clip(0, angles.count - 1)[beyond]] = True
    ranges[np.isinf(ranges) & ~seen_far] = np.nan
    return ranges.astype(np.float32)
