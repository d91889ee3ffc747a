"""The progress line of a navigation run."""

from __future__ import annotations

from evaluation.house.records import Records
from run_session.status_line import StatusLine


class Progress(StatusLine):
    """Shows which part of the run goes on, and how."""

    def __init__(self) -> None:
        super().__init__()
        self._part = ""

    def show(self, part: str, what: str, records: Records) -> None:
        """The progress line, if one is due."""
        if part != self._part:
            self.begin_anew()
            self._part = part
        self.update(records.now, lambda: (
            f"{part} {records.now:.1f} s | {what} | {records.length:.1f} m driven"
            f" | touched {len(records.contacts)} | real time x{self.factor:.2f}"))
