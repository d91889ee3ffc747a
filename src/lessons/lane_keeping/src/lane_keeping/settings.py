"""The settings of lane_keeping: a dataclass filled from a YAML file and from ROS parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from node_basics import settings
from node_basics.settings import choice, count, number

METHODS = (
    "sliding_windows", "banded_centroids", "column_scan", "histogram_peaks", "segmented_hough",
    "skeleton", "pure_pursuit",
)
BINARISE = ("global_mean", "adaptive_mean", "relative_mean")


@dataclass(frozen=True)
class Settings:
    """SI units unless the name says otherwise; shares are of 1; positions from base_footprint."""

    method: str = choice(*METHODS)

    camera_forward: float = number(-2, 2, "m, the lens ahead of the axle")
    camera_height: float = number(0.05, 3, "m, the lens above the ground")
    camera_pitch: float = number(-0.3, 1.4, "rad, downwards positive")
    camera_hfov: float = number(0.3, 2.8, "rad, horizontal field of view")
    lane_width: float = number(0.1, 10, "m, between the middles of the two lines")

    roi_share: float = number(0.2, 0.9, "share of the image's rows, from the bottom")
    binarise: str = choice(*BINARISE)
    block_px: int = count(3, 401, "px, side of the square for the local mean, odd")
    adaptive_c: float = number(-128, 128, "how much darker than its block's mean a line is, of 255")
    relative_share: float = number(0.05, 1, "a line is darker than this share of its block's mean")
    opening_px: int = count(1, 31, "px, side of the square of the opening")

    windows: int = count(3, 40, "number of windows from bottom to top")
    margin_px: int = count(5, 300, "px, half a window's width")
    min_pixels: int = count(1, 5000, "pixels that move a window; fewer are no line")

    look_ahead: float = number(0, 1, "share of the region's height, from the top")
    steer_gain: float = number(0, 20, "rad/s at an error of half the image's width")
    max_turn: float = number(0.1, 10, "rad/s")
    straight_speed: float = number(0, 5, "m/s")
    bend_speed: float = number(0, 5, "m/s")
    bend_curvature: float = number(0, 1, "1/px; more is a bend")
    bend_error: float = number(0, 1, "share of half the image's width; more is a bend")
    pursuit_distance: float = number(0.1, 5, "m ahead of the axle, for pure_pursuit")

    lost_time: float = number(0, 5, "s for which the last plan is used if no line is seen")
    search_time: float = number(0, 60, "s of turning to where the lane was before it stops")
    search_turn: float = number(0, 5, "rad/s")

    robot_front: float = number(0, 2, "m from the axle to the robot's front")
    zebra_gap: float = number(0, 3, "m between the robot's front and an occupied zebra")
    person_gap: float = number(0, 3, "m between the robot's front and a person without zebra")
    kerb: float = number(0, 2, "m beside the lines within which a person is crossing")
    waiting: float = number(0, 5, "m beside the lines within which a person is passed slowly")
    waiting_speed: float = number(0, 5, "m/s past a waiting person")
    braking: float = number(0.1, 20, "m/s^2")
    clear_time: float = number(0, 2, "s without a person before driving on")

    image_timeout: float = number(0.1, 5, "s without an image before it stops")
    frozen_time: float = number(0.1, 5, "s of identical images while driving before it stops")
    blank_contrast: float = number(0, 50, "of 255: an image with less contrast is blank")

    def __post_init__(self) -> None:
        if self.block_px % 2 == 0:
            raise ValueError(f"'block_px' must be odd, not {self.block_px}")


def load_settings(path: str | Path, given: Mapping[str, object] | None = None) -> Settings:
    """Settings from a YAML file; keys in `given`, the node's ROS parameters, take precedence.

    Any error is a SettingsError.
    """
    return settings.load_settings(Settings, path, given=given)
