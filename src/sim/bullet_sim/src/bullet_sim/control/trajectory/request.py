"""A requested trajectory, checked and joined to the current one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from bullet_sim.control.trajectory.path import Path, Segment, Waypoint
from bullet_sim.errors import SimulationError
from bullet_sim.pose import shortest_angular_distance


@dataclass(frozen=True)
class Tolerance:
    """Maximum errors of one joint; 0: not checked."""

    position: float = 0.0  # rad or m
    velocity: float = 0.0
    acceleration: float = 0.0

    def violation(self, error: Waypoint) -> str | None:
        """The name of the quantity that is out of bounds; None if none is."""
        for name in ("position", "velocity", "acceleration"):
            bound, value = getattr(self, name), getattr(error, name)
            if bound > 0.0 and value is not None and abs(value) > bound:
                return f"{name} error {value:.6g}, tolerance {bound:.6g}"
        return None

    def replaced(self, position: float, velocity: float, acceleration: float) -> Tolerance:
        """With the tolerances of a goal, see `chosen`."""
        return Tolerance(chosen(position, self.position), chosen(velocity, self.velocity),
                         chosen(acceleration, self.acceleration))


@dataclass(frozen=True)
class GoalTolerances:
    """Tolerances of all joints by name."""

    path: dict[str, Tolerance] = field(default_factory=dict)
    goal: dict[str, Tolerance] = field(default_factory=dict)
    time: float = 0.0  # s after the end within which the goal tolerances must be met


def chosen(wish: float, default: float) -> float:
    """A goal's value: positive replaces the default, negative means none, 0 keeps the default."""
    if wish > 0.0:
        return wish
    return 0.0 if wish < 0.0 else default


class InvalidTrajectory(SimulationError):
    """A trajectory that cannot be followed."""


class InvalidJoints(InvalidTrajectory):
    """The trajectory is for other joints."""


@dataclass(frozen=True)
class RequestedPoint:
    """Values in the order of the request's joints; empty: not given."""

    time: float  # s from the trajectory's start
    positions: Sequence[float]
    velocities: Sequence[float] = ()
    accelerations: Sequence[float] = ()

    def waypoint(self, column: int, offset: float = 0.0) -> Waypoint:
        """The waypoint of one joint."""
        return Waypoint(self.positions[column] + offset,
                        self.velocities[column] if self.velocities else None,
                        self.accelerations[column] if self.accelerations else None)


@dataclass(frozen=True)
class TrajectoryRequest:
    """Joints by name, in the sender's order. Without points: hold."""

    joints: Sequence[str]
    points: Sequence[RequestedPoint]
    start: float | None = None  # s; None: now


def check(request: TrajectoryRequest, joints: Sequence[str], partial: bool) -> None:
    """Raise for an invalid request; `partial`: some of the joints are enough.

    InvalidJoints or InvalidTrajectory.
    """
    _check_joints(request.joints, joints, partial)
    last = -math.inf
    for number, point in enumerate(request.points, 1):
        if not last < point.time < math.inf:
            raise InvalidTrajectory(
                f"points must be strictly increasing in time: point {number} has "
                f"time_from_start {point.time:g} s after {last:g} s")
        last = point.time
        _check_values(number, point, len(request.joints))


def _check_joints(given: Sequence[str], joints: Sequence[str], partial: bool) -> None:
    strange = [name for name in given if name not in joints]
    missing = [name for name in joints if name not in given]
    if strange or len(set(given)) < len(given) or not given or (missing and not partial):
        raise InvalidJoints(f"joints are {_listed(given)}; this controller has {_listed(joints)}"
                            + (", and each must be there once" if not partial else ""))


def _check_values(number: int, point: RequestedPoint, count: int) -> None:
    for name in ("positions", "velocities", "accelerations"):
        values = getattr(point, name)
        if len(values) != count and (len(values) or name == "positions"):
            raise InvalidTrajectory(f"point {number} has {len(values)} {name} for {count} joints")
        if not all(math.isfinite(value) for value in values):
            raise InvalidTrajectory(f"point {number} has {name} that are not finite numbers")


def join(request: TrajectoryRequest, joints: Sequence[str], continuous: Sequence[bool],
         paths: Sequence[Path], now: float) -> list[Path]:
    """The paths to follow from now on (s): the current ones until the new trajectory begins.

    Points in the past are left out. A `continuous` joint goes the shortest way to the first point
    and keeps counting turns from there. Joints that are not in the request continue.
    InvalidTrajectory if no point is later than `now`.
    """
    start = now if request.start is None else request.start  # on the same clock as `now`
    points = [point for point in request.points if start + point.time > now]
    if not points:
        late = now - start - request.points[-1].time
        raise InvalidTrajectory(f"all {len(request.points)} points are in the past, "
                                f"the last by {late:.3f} s")
    columns = {name: column for column, name in enumerate(request.joints)}
    return [
        _joined(path, points, columns[name], turns, start, now) if name in columns else path
        for name, path, turns in zip(joints, paths, continuous, strict=True)
    ]


def _joined(path: Path, points: Sequence[RequestedPoint], column: int, continuous: bool,
            start: float, now: float) -> Path:
    leaves = max(start, now)
    last, last_time = path.sample(leaves), leaves
    offset = 0.0
    if continuous:
        first = points[0].positions[column]
        offset = last.position + shortest_angular_distance(last.position, first) - first
    segments = list(path.between(now, leaves))
    for point in points:
        waypoint, time = point.waypoint(column, offset), start + point.time
        segments.append(Segment(last_time, last, time, waypoint))
        last, last_time = waypoint, time
    return Path(segments)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) or "none"
