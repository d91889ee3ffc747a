"""Scores a tracking drive: cylinder reached, distance kept, found again after being hidden.

The rules: the car has to come near within APPROACH_TIME, or within the whole drive if it only has
to get there. From the first time at which it is within BAND of the wanted distance every sample
counts: if one is outside BAND, the distance was not kept. Only the time from when the hood comes
down until the target is found again is excluded. Found again means: within BAND with the target in
view, for SETTLED.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from ai_robot_tracking.scenes.scene import FALL_TIME, HIDDEN_TIME
from ai_robot_tracking.scenes.world_file import RADIUS

from evaluation.lap import Sample

BAND = 0.3            # m off the wanted distance
APPROACH_TIME = 20.0  # s
KEEP_TIME = 60.0      # s that the distance has to be kept
FIND_TIME = 10.0      # s from the hood's rising
SETTLED = 3.0         # s
REACHED_GAP = 0.1     # m between car and cylinder: reached; it fills the camera's view
STANDING_TIME = 5.0   # s that the distance to a static cylinder has to be kept
EARLY = "ended early"  # outcome of an interrupted drive
CAMERA_X, HALF_FOV = 0.12, 0.6981317  # m before the axle, rad
# Rectangles of the car around the middle of its axle, m: half length, half width.
PARTS = np.array([(0.15, 0.11), (0.06, 0.15)])  # body, both wheels


@dataclass(frozen=True)
class Task:
    """The task of a drive."""

    way: np.ndarray               # (N, 3): s, x, y of the cylinder; one row: it is static
    hidden: tuple[float, ...]     # s, times at which the hood is down
    wanted: float | None          # m from camera to axis; None: drive up to it
    keep: float = KEEP_TIME       # s
    limit: float = 60.0           # s, of the whole drive

    def target(self, time: float) -> np.ndarray:
        """x, y of the cylinder's axis at that simulated time, m."""
        return np.array([np.interp(time, self.way[:, 0], self.way[:, axis]) for axis in (1, 2)])


@dataclass
class Hiding:
    """One period under the hood."""

    begin: float                  # s, simulated
    found_after: float | None = None  # s from the hood's rising until found again
    _since: float | None = field(default=None, repr=False)

    @property
    def end(self) -> float:
        """When the hood begins to rise, s."""
        return self.begin + HIDDEN_TIME

    def counts(self, time: float) -> bool:
        """Whether the target is hidden at that time, or not found again yet."""
        over = self.end + self.found_after if self.found_after is not None else math.inf
        return self.begin - FALL_TIME <= time < over

    def look(self, time: float, good: bool) -> None:
        """Take one more sample; `good`: at its distance and in view."""
        if time < self.end or self.found_after is not None:
            return
        self._since = (time if self._since is None else self._since) if good else None
        if self._since is not None and time - self._since >= SETTLED:
            self.found_after = self._since - self.end

    def done(self, time: float) -> bool:
        """Whether its result is final."""
        return self.found_after is not None or time > self.end + FIND_TIME + SETTLED


class TrackScorer:
    """Takes samples in order of time."""

    def __init__(self, task: Task):
        self.task = task
        self.samples: list[Sample] = []
        self.errors: list[float] = []     # m, distance minus the wanted one (or the gap, if none)
        self.approach: float | None = None  # s from the start until it was near
        self.left_at: float | None = None   # s, simulated, when the distance was not kept
        self.hidings = [Hiding(begin) for begin in task.hidden]
        self.least_gap = math.inf         # m between car and cylinder
        self.distance = 0.0               # m driven
        self.judged: list[bool] = []      # whether that sample counted

    def add(self, sample: Sample) -> None:
        """Score one more sample."""
        if self.samples and sample.time <= self.samples[-1].time:
            return
        if self.samples:
            last = self.samples[-1]
            self.distance += math.hypot(sample.x - last.x, sample.y - last.y)
        self.samples.append(sample)
        away, bearing, gap = self._see(sample)
        self.least_gap = min(self.least_gap, gap)
        wanted = self.task.wanted
        error = gap if wanted is None else away - wanted
        self.errors.append(error)
        near = gap < REACHED_GAP if wanted is None else abs(error) <= BAND
        if self.approach is None and near:
            self.approach = self.elapsed
        for hiding in self.hidings:
            hiding.look(sample.time, near and abs(bearing) < HALF_FOV)
        counts = (wanted is not None and self.approach is not None
                  and not any(hiding.counts(sample.time) for hiding in self.hidings))
        self.judged.append(counts)
        if counts and not near and self.left_at is None:
            self.left_at = sample.time

    @property
    def elapsed(self) -> float:
        """Simulated time since the first sample, s."""
        return self.samples[-1].time - self.samples[0].time if self.samples else 0.0

    @property
    def over(self) -> bool:
        """Whether the drive can be ended."""
        task = self.task
        if self.approach is None:
            late = task.limit if len(task.way) == 1 or task.wanted is None else APPROACH_TIME
            return self.elapsed > late
        if task.wanted is None:
            return True
        if self.hidings:
            return all(hiding.done(self.samples[-1].time) for hiding in self.hidings)
        keep = STANDING_TIME if len(task.way) == 1 else task.keep
        return self.elapsed > self.approach + keep

    @property
    def good(self) -> bool:
        """Whether the drive is over and fulfilled its task."""
        found = all(hiding.found_after is not None and hiding.found_after <= FIND_TIME
                    for hiding in self.hidings)
        return self.approach is not None and self.left_at is None and found and self.over

    @property
    def outcome(self) -> str:
        """The outcome in words."""
        if not self.over and self.left_at is None:
            return EARLY
        if self.approach is None:
            return "not reached"
        if any(h.found_after is None or h.found_after > FIND_TIME for h in self.hidings):
            return "not found again"
        if self.left_at is not None:
            return "distance not kept"
        return "reached" if self.task.wanted is None else "kept"

    def judged_errors(self, after: float = 0.0) -> np.ndarray:
        """Errors (m) of the samples that count, from `after` s after it was near."""
        if self.approach is None:
            return np.empty(0)
        since = self.samples[0].time + self.approach + after
        chosen = [judged and sample.time >= since
                  for judged, sample in zip(self.judged, self.samples, strict=True)]
        return np.array(self.errors)[chosen]

    def _see(self, sample: Sample) -> tuple[float, float, float]:
        """Distance from camera to axis, m; bearing, rad; gap between car and cylinder, m."""
        ahead = np.array([math.cos(sample.yaw), math.sin(sample.yaw)])
        target = self.task.target(sample.time)
        from_camera = target - (sample.x, sample.y) - CAMERA_X * ahead
        bearing = math.remainder(math.atan2(from_camera[1], from_camera[0]) - sample.yaw, math.tau)
        from_axle = target - (sample.x, sample.y)
        along, across = abs(from_axle @ ahead), abs(from_axle @ (-ahead[1], ahead[0]))
        outside = np.maximum((along, across) - PARTS, 0.0)
        return (float(np.linalg.norm(from_camera)), bearing,
                float(np.linalg.norm(outside, axis=1).min()) - RADIUS)
