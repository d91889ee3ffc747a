"""From a colour image to a mask of possible lane lines: region, grey, threshold, opening.

Lines are darker than the road, so the thresholds are inverted.
"""

from __future__ import annotations

import cv2
import numpy as np

from lane_keeping.settings import Settings


def region(image: np.ndarray, share: float) -> np.ndarray:
    """The bottom rows of an image, a share of its height; a view, not a copy."""
    return image[image.shape[0] - round(share * image.shape[0]) :]


def global_mean(grey: np.ndarray) -> np.ndarray:
    """(h, w) uint8 to a mask: 255 where darker than the mean of all pixels."""
    return cv2.threshold(grey, float(grey.mean()), 255, cv2.THRESH_BINARY_INV)[1]


def adaptive_mean(grey: np.ndarray, block_px: int, c: float) -> np.ndarray:
    """(h, w) uint8 to a mask: 255 where darker than the mean of the surrounding block, minus c."""
    return cv2.adaptiveThreshold(
        grey, 255, cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY_INV, block_px, c
    )


def relative_mean(grey: np.ndarray, block_px: int, share: float) -> np.ndarray:
    """(h, w) uint8 to a mask: 255 where darker than a share of the surrounding block's mean.

    Light and shade multiply the brightness of line and road alike, so their ratio does not change.
    """
    mean = cv2.blur(grey, (block_px, block_px), borderType=cv2.BORDER_REPLICATE)
    return cv2.compare(grey, cv2.convertScaleAbs(mean, alpha=share), cv2.CMP_LT)


def opening(mask: np.ndarray, side_px: int) -> np.ndarray:
    """The mask without details smaller than a square of this size."""
    return cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((side_px, side_px), np.uint8))


def line_mask(image: np.ndarray, settings: Settings) -> np.ndarray:
    """(h, w, 3) BGR to a mask of its region of interest, 255 where a line may be."""
    grey = cv2.cvtColor(region(image, settings.roi_share), cv2.COLOR_BGR2GRAY)
    if settings.binarise == "global_mean":
        mask = global_mean(grey)
    elif settings.binarise == "adaptive_mean":
        mask = adaptive_mean(grey, settings.block_px, settings.adaptive_c)
    else:
        mask = relative_mean(grey, settings.block_px, settings.relative_share)
    return opening(mask, settings.opening_px)
