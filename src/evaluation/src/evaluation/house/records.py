"""Records of one part of the run: true and estimated poses, and the robot's contacts."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nav_algorithms.poses import compose, wrap_angle
from nav_algorithms.trajectory_error import at_moments
from run_session.status_line import StatusLine
from trial_worlds.feelers import Gap

TOUCHES = 0.005  # m; a smaller gap counts as contact, as poses are sampled at only 25 Hz
LONGEST_GAP = 0.2  # s, simulated, between two true poses, across which to interpolate
APART = 0.5  # s, simulated, after which a contact counts as a new one


@dataclass
class Contact:
    """The robot touched something for a while."""

    own: str  # the robot's collision element that touched first
    begin: float  # s, simulated
    end: float
    place: tuple[float, float]  # m, where it began, in the world


@dataclass
class Records:
    """Filled by callbacks in other threads; poses are (x, y, yaw), m and rad."""

    truth: list[tuple[float, float, float, float]] = field(default_factory=list)  # stamp, pose
    believed: list[tuple[float, float, float, float]] = field(default_factory=list)  # on the map
    contacts: list[Contact] = field(default_factory=list)
    nearest: tuple[float, float] = (np.inf, 0.0)  # smallest gap to anything, m, and when, s
    begun: float = 0.0  # s, simulated, from which on the robot may drive

    @property
    def now(self) -> float:
        """Simulated time, s, of the last true pose; 0 before the first."""
        return self.truth[-1][0] if self.truth else 0.0

    @property
    def true_pose(self) -> np.ndarray:
        """The last one (3,), in the world's frame."""
        return np.array(self.truth[-1][1:])

    @property
    def believed_pose(self) -> np.ndarray:
        """The last one (3,), in the map's frame."""
        return np.array(self.believed[-1][1:])

    @property
    def length(self) -> float:
        """Distance driven, m."""
        places = np.array(self.truth).reshape(-1, 4)[:, 1:3]
        return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())

    @property
    def longest_unseen(self) -> float:
        """The longest time, s, simulated, between two true poses since `begun`."""
        times = [row[0] for row in self.truth if row[0] >= self.begun]
        return max(np.diff(times), default=0.0)

    def show(self, progress: StatusLine, part: str, what: str) -> None:
        """Show the progress line of a part of the run, if one is due."""
        progress.update(self.now, lambda: (
            f"{part} {self.now:.1f} s | {what} | {self.length:.1f} m driven"
            f" | touched {len(self.contacts)} | real time x{progress.factor:.2f}"), part)

    def note_gap(self, gap: Gap, now: float) -> None:
        """Record the robot's gap to the nearest object at this time, s; small gaps are contacts."""
        self.nearest = min(self.nearest, (gap.width, now))
        if gap.width > TOUCHES:
            return
        if self.contacts and now - self.contacts[-1].end < APART:
            self.contacts[-1].end = now
        else:
            self.contacts.append(Contact(gap.own, now, now, gap.place))

    def errors(self, since: float, map_in_world: np.ndarray = np.zeros(3)
               ) -> tuple[np.ndarray, np.ndarray]:
        """Times (N,), s, and errors (N, 2), m and rad, of the estimated pose at those times."""
        times, believed, true = self.moments(since)
        there = compose(map_in_world, believed)
        return times, np.stack((np.linalg.norm(there[:, :2] - true[:, :2], axis=1),
                                np.abs(wrap_angle(there[:, 2] - true[:, 2]))), axis=1)

    def moments(self, since: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times (N,), s, from `since` on, with estimated and true poses (N, 3).

        Leaves out gaps between true poses longer than LONGEST_GAP: the robot may have turned.
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
