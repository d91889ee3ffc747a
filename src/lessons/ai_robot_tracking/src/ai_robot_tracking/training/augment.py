"""Random augmentation of training images: mirrored, zoomed, in another light."""

from __future__ import annotations

import math

import cv2
import numpy as np

from ai_robot_tracking.detection.letterbox import PADDING

ZOOM = (0.6, 1.7)
LEAST_KEPT = 0.5  # of a box's area, for it to still count
SMALLEST_PX = 6.0  # of the input: 12 px in an image twice as wide


def augmented(
    rng: np.random.Generator, image: np.ndarray, labels: np.ndarray, size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """A changed image of `size` (height, width), with its labels (n, 6); see `drawing.FIELDS`.

    A smaller image gets a part of the original, or all of it scaled down.
    """
    labels = labels.copy()
    if rng.random() < 0.5:
        labels[:, [1, 3]] = image.shape[1] - labels[:, [3, 1]]
        image = image[:, ::-1]
    smaller = math.sqrt(size[1] / image.shape[1])  # between all of it and its original scale
    factor = smaller * math.exp(rng.uniform(*np.log(ZOOM))) if rng.random() < 0.7 else smaller
    if factor != 1 or size != image.shape[:2]:
        image, labels = _zoomed(rng, np.ascontiguousarray(image), labels, factor, size)
    return _relit(rng, image), labels


def _zoomed(
    rng: np.random.Generator, image: np.ndarray, labels: np.ndarray, factor: float,
    size: tuple[int, int],
) -> tuple[np.ndarray, np.ndarray]:
    height, width = size
    slack = np.array((width, height)) - np.array(image.shape[1::-1]) * factor
    offset = slack * rng.uniform(0, 1, 2)
    matrix = np.array([[factor, 0, offset[0]], [0, factor, offset[1]]])
    image = cv2.warpAffine(image, matrix, (width, height), borderValue=(PADDING,) * 3)
    whole = labels[:, 1:5] * factor + np.tile(offset, 2)
    labels[:, 1:5] = np.clip(whole, 0, (width, height) * 2)
    sides, before = labels[:, 3:5] - labels[:, 1:3], whole[:, 2:] - whole[:, :2]
    kept = sides.prod(axis=1) >= LEAST_KEPT * before.prod(axis=1)
    labels[:, 5] *= kept & (sides.min(axis=1) >= SMALLEST_PX)
    return image, labels[sides.min(axis=1) > 1]


def _relit(rng: np.random.Generator, image: np.ndarray) -> np.ndarray:
    gain = rng.uniform(0.6, 1.35) * rng.uniform(0.88, 1.12, 3)
    table = np.arange(256)[:, None] / 255 * gain
    table = np.clip(table, 0, 1) ** math.exp(rng.uniform(-0.25, 0.25)) * 255
    image = cv2.LUT(np.ascontiguousarray(image), table.round().astype(np.uint8)[None])
    if rng.random() < 0.15:
        image = cv2.blur(image, (2, 2))
    if rng.random() < 0.2:
        grain = rng.standard_normal(image.shape, np.float32) * rng.uniform(1, 7)
        image = cv2.add(image, grain, dtype=cv2.CV_8U)
    return image
