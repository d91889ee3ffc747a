"""One joint's whole trajectory: a sequence of segments."""

from bisect import bisect_right
from collections.abc import Sequence

from bullet_sim.control.trajectory.segment import Segment, Waypoint


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
