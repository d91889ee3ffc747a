"""The tutorial's control law: turn in proportion to the error in pixels, at one of three speeds.

It never stops before the target: it drives up to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ai_robot_tracking.red_target import Blob, RedSettings, find_blobs, red_mask
from ai_robot_tracking.settings import number


@dataclass(frozen=True)
class PageSettings(RedSettings):
    """Section visual_tracker of the parameter file: colour bounds, and the law's parameters."""

    turn_gain: float = number(0, 1, "rad/s per px from the middle")
    straight_error: float = number(0, 2000, "px; less error: the target is straight ahead")
    near_radius: float = number(0, 2000, "px")
    far_radius: float = number(0, 2000, "px")
    fast_speed: float = number(0, 2, "m/s, if the target is ahead and larger than near_radius")
    far_speed: float = number(0, 2, "m/s, if the target is smaller than far_radius")
    slow_speed: float = number(0, 2, "m/s, otherwise")
    search_turn: float = number(0, 5, "rad/s, if nothing red is in sight")
    small_turn: float = number(0, 5, "rad/s, if the red blob has least_radius or less")
    image_timeout: float = number(0.05, 60, "s without a new image until it stops")


def largest_blob(picture: np.ndarray, settings: PageSettings) -> Blob | None:
    """The largest red blob in a BGR image (rows, columns, 3), however small; or None."""
    blobs = find_blobs(red_mask(picture, settings.colour), 0)
    return blobs[0] if blobs else None


def page_command(blob: Blob | None, width: int, settings: PageSettings) -> tuple[float, float]:
    """Speed (m/s) and turn rate (rad/s, left positive) for a blob; `width`: of the image, px."""
    if blob is None:
        return 0.0, settings.search_turn
    if blob.radius <= settings.least_radius:
        return 0.0, settings.small_turn
    error = blob.column - width / 2  # px, positive on the right
    if abs(error) < settings.straight_error and blob.radius > settings.near_radius:
        speed = settings.fast_speed
    elif blob.radius < settings.far_radius:
        speed = settings.far_speed
    else:
        speed = settings.slow_speed
    return speed, -settings.turn_gain * error
