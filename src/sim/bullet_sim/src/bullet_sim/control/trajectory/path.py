"""One joint's whole trajectory: a sequence of segments."""

from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple

SHORTEST = 1e-9  # s; with a shorter duration, a joint is at the end at once


class Waypoint(NamedTuple):
    """A joint's state; None for values that a trajectory does not give."""

    position: float  # rad or m
    velocity: float | None = None
    acceleration: float | None = None


class Segment:
    """Interpolates with all values that both ends give: position, velocity, acceleration.

    Before its start and after its end the joint stands still at that end.
    """

    __slots__ = ("start_time", "end_time", "_ends", "_coefficients")

    def __init__(self, start_time: float, start: Waypoint, end_time: float, end: Waypoint):
        self.start_time = start_time  # s
        self.end_time = end_time
        self._ends = (start, end)
        self._coefficients = _coefficients(start, end, end_time - start_time)

    def sample(self, time: float) -> Waypoint:
        """Position, velocity and acceleration at a time."""
        if time < self.start_time:
            return Waypoint(self._ends[0].position, 0.0, 0.0)
        if time > self.end_time or self.end_time - self.start_time < SHORTEST:
            return Waypoint(self._ends[1].position, 0.0, 0.0)
        position = velocity = acceleration = 0.0
        elapsed = time - self.start_time
        for coefficient in self._coefficients:  # Horner's rule, highest power first
            acceleration = acceleration * elapsed + 2.0 * velocity
            velocity = velocity * elapsed + position
            position = position * elapsed + coefficient
        return Waypoint(position, velocity, acceleration)


def _coefficients(start: Waypoint, end: Waypoint, duration: float) -> tuple[float, ...]:
    """Coefficients of the polynomial in the time since the start, highest power first."""
    p0, v0, a0 = start
    p1, v1, a1 = end
    if duration < SHORTEST:
        return (p1,)
    t = duration
    if v0 is None or v1 is None:
        return ((p1 - p0) / t, p0)
    if a0 is None or a1 is None:
        # What a cubic adds to the line p0 + v0 s to meet the end.
        gap, rate = p1 - p0 - v0 * t, v1 - v0
        return ((rate * t - 2 * gap) / t**3, (3 * gap - rate * t) / t**2, v0, p0)
    # The same for a quintic and the parabola p0 + v0 s + a0 s^2 / 2.
    gap, rate, bend = p1 - p0 - v0 * t - a0 * t * t / 2, v1 - v0 - a0 * t, a1 - a0
    return ((12 * gap - 6 * rate * t + bend * t * t) / (2 * t**5),
            (-30 * gap + 14 * rate * t - 2 * bend * t * t) / (2 * t**4),
            (20 * gap - 8 * rate * t + bend * t * t) / (2 * t**3),
            a0 / 2, v0, p0)


class Path:
    """Segments in the order of time; between two of them the end of the earlier one is held."""

    def __init__(self, segments: Sequence[Segment]):
        self.segments = tuple(segments)
        self._starts = [segment.start_time for segment in self.segments]

    @property
    def end_time(self) -> float:
        """When the last segment ends, s."""
        return self.segments[-1].end_time

    def index(self, time: float) -> int:
        """The index of the segment at a time; the first one before that begins."""
        return max(0, bisect_right(self._starts, time) - 1)

    def sample(self, time: float) -> Waypoint:
        """Position, velocity and acceleration at a time."""
        return self.segments[self.index(time)].sample(time)

    def between(self, start: float, end: float) -> tuple[Segment, ...]:
        """The segments that are followed between two times."""
        return self.segments[self.index(start):self.index(end) + 1]


def stopping(time: float, position: float, velocity: float, duration: float) -> Path:
    """Brings a moving joint to rest in `duration` s, to the position where constant braking ends.

    With a duration of 0, the joint is held where it is.
    """
    end = Waypoint(position + velocity * duration / 2, 0.0, 0.0)
    return Path([Segment(time, Waypoint(position, velocity, 0.0), time + duration, end)])
