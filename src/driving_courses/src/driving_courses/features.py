"""What is seen of a course in few numbers: where marks of one colour are in a picture."""

from __future__ import annotations

import cv2
import numpy as np

from driving_courses.course import FeatureSpec

PER_BAND = 3  # numbers: whether it is seen, where, how much


def feature_count(spec: FeatureSpec) -> int:
    """How many numbers `find_features` gives."""
    return PER_BAND * len(spec.bands) * (2 if spec.halves else 1)


def find_features(rgb: np.ndarray, spec: FeatureSpec) -> np.ndarray:
    """For each band: 1 if the colour is in it, else 0; its middle's column, -1 left to 1 right;
    its share of the band's pixels, 0 to 1. What is not seen is at column 0.

    `rgb` is (height, width, 3) uint8 of any size; the result is (feature_count,) float32.
    """
    height, width = rgb.shape[:2]
    columns = (np.arange(width) + 0.5) * 2 / width - 1
    found = []
    for top, bottom in spec.bands:
        first = int(top * height)
        rows = rgb[first:max(first + 1, round(bottom * height))]
        counts = _mask(rows, spec).sum(axis=0, dtype=np.int64)
        parts = np.array_split(np.arange(width), 2) if spec.halves else [slice(None)]
        for part in parts:
            count = counts[part].sum()
            middle = counts[part] @ columns[part] / count if count else 0.0
            found += [float(count > 0), middle, count / (len(rows) * len(counts[part]))]
    return np.array(found, np.float32)


def shrink(rgb: np.ndarray, spec: FeatureSpec) -> np.ndarray:
    """A picture of another size in the size that features were learned on, (height, width, 3)."""
    if rgb.shape[1::-1] == spec.size:
        return rgb
    return cv2.resize(rgb, spec.size, interpolation=cv2.INTER_AREA)


def _mask(rgb: np.ndarray, spec: FeatureSpec) -> np.ndarray:
    """(rows, columns) bool."""
    hsv = cv2.cvtColor(np.ascontiguousarray(rgb), cv2.COLOR_RGB2HSV)
    if spec.lower[0] <= spec.upper[0]:
        return cv2.inRange(hsv, spec.lower, spec.upper) > 0
    low = cv2.inRange(hsv, (0, *spec.lower[1:]), spec.upper)
    high = cv2.inRange(hsv, spec.lower, (179, *spec.upper[1:]))
    return (low | high) > 0
