"""Follows the cylinder at a distance: PID on bearing and distance; searches when it is lost."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from node_basics.settings import number

from ai_robot_tracking.red_target import (
    Blob,
    Colour,
    bearing_of,
    distance_of,
    find_blobs,
    looks_upright,
    red_mask,
    split_off,
)


@dataclass(frozen=True)
class Gains:
    """Gains of the error, its integral, and its derivative."""

    p: float
    i: float
    d: float


class Pid:
    """One loop; times in s; the units of errors and outputs follow from the gains."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Reset the integral and the last error."""
        self._sum, self._last = 0.0, None

    def update(self, error: float, period: float, gains: Gains, low: float, high: float) -> float:
        """The output, between `low` and `high`, for an error `period` (s) after the last one."""
        change = (error - self._last) / period if self._last is not None and period > 0 else 0.0
        self._last = error
        grown = self._sum + error * period
        wanted = gains.p * error + gains.i * grown + gains.d * change
        bounded = min(max(wanted, low), high)
        if wanted == bounded or error * (wanted - bounded) < 0:  # anti-windup
            self._sum = grown
        return bounded


FOLLOWING, WAITING, SEARCHING = "following", "waiting", "searching"
LONGEST_PERIOD = 0.2  # s, the most that counts between two images
RATE_SMOOTHING = 0.3  # s over which the target's bearing rate is smoothed
LEAP = 0.5            # rad, or share of the distance: a larger jump means another object


@dataclass(frozen=True)
class FollowerSettings:
    """Section visual_tracker_pid of the parameter file: colour bounds, and the PID's parameters."""

    hue_low: float = number(0, 180, "0..180; larger than hue_high: the range passes through 180")
    hue_high: float = number(0, 180, "0..180")
    saturation_low: float = number(0, 255, "0..255")
    value_low: float = number(0, 255, "0..255")
    least_radius: float = number(0, 1000, "px; smaller blobs are ignored")
    target_radius: float = number(0.01, 10, "m, of the cylinder")
    target_height: float = number(0.01, 10, "m")
    camera_hfov: float = number(0.1, 3.0, "rad")
    wanted_distance: float = number(0.1, 20, "m from the camera to the cylinder's axis")
    kp_turn: float = number(0, 20, "rad/s per rad")
    ki_turn: float = number(0, 20, "rad/s per rad s")
    kd_turn: float = number(0, 20, "rad/s per rad/s")
    kp_distance: float = number(0, 20, "m/s per m")
    ki_distance: float = number(0, 20, "m/s per m s")
    kd_distance: float = number(0, 20, "m/s per m/s")
    max_speed: float = number(0, 5, "m/s, forward")
    max_reverse: float = number(0, 5, "m/s")
    max_turn: float = number(0, 10, "rad/s")
    patience: float = number(0, 60, "s without the target before it searches")
    search_turn: float = number(0, 10, "rad/s")
    search_angle: float = number(0, 3.1, "rad to each side before it turns all the way round")
    image_timeout: float = number(0.05, 60, "s without a new image until it stops")

    @property
    def colour(self) -> Colour:
        """The mask's colour bounds."""
        return Colour(self.hue_low, self.hue_high, self.saturation_low, self.value_low)


@dataclass(frozen=True)
class Sighting:
    """The target in an image: rad to the left of the camera's axis, and m to its axis."""

    bearing: float
    distance: float
    blob: Blob


def sighting(blob: Blob, shape: tuple[int, int], settings: FollowerSettings) -> Sighting:
    """The sighting if the blob is the target; `shape`: the image's rows and columns."""
    return Sighting(
        bearing_of(blob, shape[1], settings.camera_hfov),
        distance_of(blob, shape, settings.camera_hfov, settings.target_radius,
                    settings.target_height), blob)


class Follower:
    """Returns a command for each image, in order."""

    def __init__(self, settings: FollowerSettings):
        self.settings = settings
        self.state = WAITING
        self.seen: Sighting | None = None  # in the last image; None: not in sight
        self._turn, self._speed = Pid(), Pid()
        self._time: float | None = None  # s, of the last image
        self._last: Sighting | None = None
        self._lost_for, self._side = math.inf, 1.0
        self._drift = 0.0  # rad/s at which the target moves round the robot, left positive
        self._turning = 0.0  # rad/s, last command

    def drive(self, picture: np.ndarray, time: float) -> tuple[float, float]:
        """Speed (m/s) and turn rate (rad/s, left positive) for a BGR image at this time (s)."""
        period = 0.0 if self._time is None else min(max(time - self._time, 0.0), LONGEST_PERIOD)
        self._time = time
        self.seen = self._look(picture)
        speed, self._turning = (self._search(period) if self.seen is None
                                else self._follow(self.seen, period))
        return speed, self._turning

    def halt(self) -> None:
        """The robot is being stopped: start again with the next image."""
        self._turn.restart()
        self._speed.restart()
        self._time, self._turning, self._drift = None, 0.0, 0.0

    def _look(self, picture: np.ndarray) -> Sighting | None:
        """The blob nearest to the target's last place; after a loss, the largest of its shape."""
        s, shape = self.settings, picture.shape[:2]
        mask = red_mask(picture, s.colour)
        blobs = find_blobs(mask, s.least_radius)
        if self._last is None or self._lost_for > s.patience:
            return next((sighting(blob, shape, s) for blob in blobs
                         if looks_upright(blob, shape, s.target_radius, s.target_height)), None)
        last, before = self._last, self._last.blob
        expected = before.left + before.width / 2, before.height
        found = [sighting(split_off(mask, blob, *expected), shape, s) for blob in blobs]

        def leap(each: Sighting) -> float:
            return abs(each.bearing - last.bearing) + abs(each.distance / last.distance - 1)

        near = min(found, key=leap, default=None)
        return near if near is not None and leap(near) < LEAP else None

    def _follow(self, seen: Sighting, period: float) -> tuple[float, float]:
        s, last = self.settings, self._last
        if last is not None and self._lost_for == 0.0 and period > 0:
            own = (seen.bearing - last.bearing) / period + self._turning
            self._drift += min(period / RATE_SMOOTHING, 1.0) * (own - self._drift)
        elif self._lost_for > 0:
            self._turn.restart()
            self._speed.restart()
            self._drift = 0.0
        self._last, self._lost_for, self.state = seen, 0.0, FOLLOWING
        turn = self._turn.update(seen.bearing, period, Gains(s.kp_turn, s.ki_turn, s.kd_turn),
                                 -s.max_turn, s.max_turn)
        gains = Gains(s.kp_distance, s.ki_distance, s.kd_distance)
        speed = self._speed.update(seen.distance - s.wanted_distance, period, gains,
                                   -s.max_reverse, s.max_speed)
        return speed * max(math.cos(2 * seen.bearing), 0.0), turn  # turn to it first, then drive

    def _search(self, period: float) -> tuple[float, float]:
        """Wait a moment, turn to the side where it was last seen, to the other, then all round."""
        s = self.settings
        if self._lost_for == 0.0:
            self._side = math.copysign(1.0, self._last.bearing + self._drift)
        self._lost_for += period
        if self._lost_for <= s.patience:
            self.state = WAITING
            return 0.0, 0.0
        self.state = SEARCHING
        turned = (self._lost_for - s.patience) * s.search_turn
        back = s.search_angle <= turned < 3 * s.search_angle
        return 0.0, (-self._side if back else self._side) * s.search_turn
