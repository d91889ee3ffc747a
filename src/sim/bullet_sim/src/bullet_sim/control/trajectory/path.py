"""One joint's whole trajectory: segments in a row."""

from bisect import bisect_right
from collections.abc import Sequence

from bullet_sim.control.trajectory.segment import Segment, Waypoint


class Path:
    """Segments in the order of time; between two of them the earlier one's end is held."""

    def __init__(self, segments: Sequence[Segment]):
        self.segments = tuple(segments)
        self._starts = [segment.start_time for segment in self.segments]

    @property
    def end_time(self) -> float:
        """When the last segment ends, s."""
        return self.segments[-1].end_time

    def index(self, time: float) -> int:
        """Of the segment that is followed at a moment; the first one before that begins."""
        return max(0, bisect_right(self._starts, time) - 1)

    def sample(self, time: float) -> Waypoint:
        """Position, velocity and acceleration at a moment."""
        return self.segments[self.index(time)].sample(time)

    def between(self, start: float, end: float) -> tuple[Segment, ...]:
        """The segments that are followed from one moment to another."""
        return self.segments[self.index(start):self.index(end) + 1]


def stopping(time: float, position: float, velocity: float, duration: float) -> Path:
    """From a moving joint to a standing one in `duration` s, as even braking would end.

    Without any duration the joint is held where it is.
    """
    end = Waypoint(position + velocity * duration / 2, 0.0, 0.0)
    return Path([Segment(time, Waypoint(position, velocity, 0.0), time + duration, end)])
