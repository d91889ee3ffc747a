"""Colours of points by a value, as rviz has them. Without ROS."""

from typing import Any

import numpy as np

from sim_viewer.rviz.options import rgb


def rgba(options: dict[str, Any], color: str = "Color", alpha: str = "Alpha") -> tuple:
    """Red, green, blue, alpha, 0 to 255, from two options; without an alpha option opaque."""
    return (*rgb(options[color]), round(255 * options.get(alpha, 1.0)))


def rainbow(values: np.ndarray) -> np.ndarray:
    """(n, 3) uint8 of values from 0 (red) to 1 (magenta), as rviz has them."""
    hue = np.clip(1.0 - values, 0.0, 1.0) * 5.0 + 1.0
    step = np.floor(hue).astype(int)
    rest = hue - step
    rest = np.where(step % 2 == 0, 1.0 - rest, rest)
    down, zero, one = 1.0 - rest, np.zeros_like(rest), np.ones_like(rest)
    # Which of (down, 0, 1) is red, green and blue in each of the five steps.
    table = np.stack([down, zero, one], axis=1)
    order = np.array([[0, 1, 2], [1, 0, 2], [1, 2, 0], [0, 2, 1], [2, 0, 1]])[
        np.clip(step - 1, 0, 4)]
    return (255 * np.take_along_axis(table, order, axis=1)).astype(np.uint8)


def between(values: np.ndarray, low: str, high: str) -> np.ndarray:
    """(n, 3) uint8 from one colour (0) to another (1)."""
    first, last = np.array(rgb(low), float), np.array(rgb(high), float)
    return (first + np.clip(values, 0.0, 1.0)[:, None] * (last - first)).astype(np.uint8)


def spread(values: np.ndarray, bounds: tuple[float, float] | None) -> np.ndarray:
    """Values scaled to 0..1 from these bounds, or from their own; NaN and infinity become 0."""
    values = np.where(np.isfinite(values), values, np.nan).astype(float)
    if bounds is None:
        known = values[~np.isnan(values)]
        bounds = (known.min(), known.max()) if known.size else (0.0, 1.0)
    span = bounds[1] - bounds[0]
    return np.nan_to_num((values - bounds[0]) / (span if span else 1.0), nan=0.0)
