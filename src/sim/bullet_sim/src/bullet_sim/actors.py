"""Moves actors along their trajectories, by simulated time."""

import itertools
import math

import numpy as np

from bullet_sim.description import Trajectory
from bullet_sim.model import Model
from bullet_sim.pose import Pose, Quaternion, normalised

PERIOD = 1 / 30  # s, simulated, between two poses


class Actor:
    """One actor. Collisions do not stop it: its script alone determines its pose."""

    def __init__(self, model: Model, trajectory: Trajectory):
        self.model = model
        self._trajectory = trajectory
        self._place: Pose | None = None
        self._last = math.inf  # s, time of the last move

    def walk(self, time: float) -> None:
        """Move it to its pose at that simulated time (s); to be called after each step."""
        if self._last <= time < self._last + PERIOD - 1e-9:
            return
        self._last = time
        place = pose_at(self._trajectory, time)
        if place != self._place:  # an actor that stands still may come to rest
            self._place = place
            self.model.set_pose(place)


def pose_at(trajectory: Trajectory, time: float) -> Pose:
    """Pose in the world at a simulated time (s): straight between waypoints."""
    waypoints = trajectory.waypoints
    if not trajectory.auto_start:
        return waypoints[0][1]
    end = waypoints[-1][0]
    since = time - trajectory.delay_start
    if trajectory.loop and end > 0 and trajectory.delay_start >= 0:
        since = time % (end + trajectory.delay_start) - trajectory.delay_start
    if since <= waypoints[0][0]:
        return waypoints[0][1]
    for (start, a), (stop, b) in itertools.pairwise(waypoints):
        if since < stop:
            return between(a, b, (since - start) / (stop - start))
    return waypoints[-1][1]


def between(a: Pose, b: Pose, part: float) -> Pose:
    """The pose at `part` (0..1) of the way from one to the other, turning at a constant rate."""
    position = tuple(p + part * (q - p) for p, q in zip(a.position, b.position, strict=True))
    return Pose(position, _slerp(a.orientation, b.orientation, part))


def _slerp(a: Quaternion, b: Quaternion, part: float) -> Quaternion:
    start, end = np.array(a), np.array(b)
    cosine = float(start @ end)
    if cosine < 0:
        end, cosine = -end, -cosine
    if cosine > 0.9999:
        return normalised(start + part * (end - start))
    angle = math.acos(cosine)
    return normalised(
        (math.sin((1 - part) * angle) * start + math.sin(part * angle) * end) / math.sin(angle))
