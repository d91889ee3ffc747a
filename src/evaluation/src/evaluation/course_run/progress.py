"""The run's progress line."""

from __future__ import annotations

from evaluation.lap import LapScorer
from evaluation.session.status_line import StatusLine


class Progress(StatusLine):
    """Shows how the drive stands."""

    def show(self, drive: LapScorer) -> None:
        """The progress line, if one is due."""
        self.update(drive.samples[-1].time, lambda: self._line(drive))

    def _line(self, drive: LapScorer) -> str:
        lap = min(len(drive.laps) + 1, drive.wanted_laps)
        return (
            f"simulated {drive.samples[-1].time:.1f} s | {drive.total.distance:.2f} m"
            f" | lap {lap}/{drive.wanted_laps} {drive.driven_share:4.0%}"
            f" | off line {drive.lateral * 100:+.1f} cm | real time x{self.factor:.2f}"
        )
