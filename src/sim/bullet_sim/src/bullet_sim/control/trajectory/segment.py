"""One joint's motion between two times: a linear, cubic or quintic polynomial of time."""

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
