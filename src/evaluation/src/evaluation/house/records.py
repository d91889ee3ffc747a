"""What was seen in one part of the run: true and believed poses, and what the robot touched."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nav_algorithms.poses import compose, wrap_angle
from nav_algorithms.trajectory_error import at_moments
from run_session.status_line import StatusLine
from trial_worlds.feelers import Gap

TOUCHES = 0.005  # m; what is nearer counts as touched: poses are seen 25 times a second
LONGEST_GAP = 0.2  # s, simulated, between two true poses that what lies between is known of
APART = 0.5  # s, simulated, after which it touches anew


@dataclass
class Contact:
    """The robot touched something for a while."""

    own: str  # collision of the robot, where it began
    begin: float  # s, simulated
    end: float
    place: tuple[float, float]  # m, where it began, in the world


@dataclass
class Records:
    """Grows by callbacks of other threads; poses are (x, y, yaw), m and rad."""

    truth: list[tuple[float, float, float, float]] = field(default_factory=list)  # stamp, pose
    believed: list[tuple[float, float, float, float]] = field(default_factory=list)  # on the map
    contacts: list[Contact] = field(default_factory=list)
    nearest: tuple[float, float] = (np.inf, 0.0)  # smallest gap to anything, m, and when, s
    begun: float = 0.0  # s, simulated, of the pose from which on it drives

    @property
    def now(self) -> float:
        """s, simulated, of the last true pose; 0 before the first."""
        return self.truth[-1][0] if self.truth else 0.0

    @property
    def true_pose(self) -> np.ndarray:
        """The last, in the world's frame."""
        return np.array(self.truth[-1][1:])

    @property
    def believed_pose(self) -> np.ndarray:
        """The last, in the map's frame."""
        return np.array(self.believed[-1][1:])

    @property
    def length(self) -> float:
        """m driven."""
        places = np.array(self.truth).reshape(-1, 4)[:, 1:3]
        return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())

    @property
    def longest_unseen(self) -> float:
        """s, simulated, between two looks at the true pose since it drives, at most."""
        times = [row[0] for row in self.truth if row[0] >= self.begun]
        return max(np.diff(times), default=0.0)

    def show(self, progress: StatusLine, part: str, what: str) -> None:
        """The progress line of a part of the run, if one is due."""
        progress.update(self.now, lambda: (
            f"{part} {self.now:.1f} s | {what} | {self.length:.1f} m driven"
            f" | touched {len(self.contacts)} | real time x{progress.factor:.2f}"), part)

    def note_gap(self, gap: Gap, now: float) -> None:
        """So near is the robot to something at this moment, s."""
        self.nearest = min(self.nearest, (gap.width, now))
        if gap.width > TOUCHES:
            return
        if self.contacts and now - self.contacts[-1].end < APART:
            self.contacts[-1].end = now
        else:
            self.contacts.append(Contact(gap.own, now, now, gap.place))

    def errors(self, since: float, map_in_world: np.ndarray = np.zeros(3)
               ) -> tuple[np.ndarray, np.ndarray]:
        """Times (N,), s, and (N, 2), m and rad between believed and true pose then."""
        times, believed, true = self.moments(since)
        there = compose(map_in_world, believed)
        return times, np.stack((np.linalg.norm(there[:, :2] - true[:, :2], axis=1),
                                np.abs(wrap_angle(there[:, 2] - true[:, 2]))), axis=1)

    def moments(self, since: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times (N,), s, believed and true poses (N, 3) then, from a moment on.

        Not where the true pose was not seen for LONGEST_GAP: it may have turned meanwhile.
        """
        believed = np.array(self.believed[:]).reshape(-1, 4)
        truth = np.array(self.truth[:]).reshape(-1, 4)
        if not len(truth):
            return np.empty(0), np.empty((0, 3)), np.empty((0, 3))
        moments = believed[:, 0]
        true_poses = at_moments(truth[:, 0], truth[:, 1:], moments)
        after = np.searchsorted(truth[:, 0], moments).clip(1, max(len(truth) - 1, 1))
        unseen = np.diff(truth[:, 0], append=np.inf)[after - 1] > LONGEST_GAP
        known = np.isfinite(true_poses[:, 0]) & ~unseen & (moments >= since)
        return moments[known], believed[known, 1:], true_poses[known]
