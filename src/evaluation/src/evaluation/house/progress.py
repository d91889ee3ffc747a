"""The progress line of a navigation run."""

from __future__ import annotations

import numpy as np

from evaluation.house.records import Records
from run_session.status_line import StatusLine


class Progress(StatusLine):
    """Shows which part of the run goes on, and how."""

    def __init__(self) -> None:
        super().__init__()
        self._part, self._length, self._counted = "", 0.0, 0

    def show(self, part: str, what: str, records: Records) -> None:
        """The progress line, if one is due."""
        if part != self._part:
            self.begin_anew()
            self._part, self._length, self._counted = part, 0.0, 0
        self.update(records.now, lambda: self._line(what, records))

    def _line(self, what: str, records: Records) -> str:
        fresh = np.array(records.truth[max(self._counted - 1, 0):])
        self._length += float(np.linalg.norm(np.diff(fresh[:, 1:3], axis=0), axis=1).sum())
        self._counted = len(records.truth)
        return (f"{self._part} {records.now:.1f} s | {what} | {self._length:.1f} m driven"
                f" | touched {len(records.contacts)} | real time x{self.factor:.2f}")
