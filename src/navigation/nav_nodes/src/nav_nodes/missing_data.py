"""Logs what is missing and for how long: one line for all of it, at most every 5 s."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass

import rospy

INTERVAL = 5.0    # s of wall time between two lines about the same absence
GATHERING = 0.3   # s that a first line waits for others that are missing for the same reason
SOON = 3.0        # s, at most, between a root cause and its result
RECENT = 2.0      # s since the last report, within which an absence is logged
FORGOTTEN = 12.0  # s without reports, after which a report begins a new absence


@dataclass
class _Absence:
    since: float
    patience: float
    advice: str
    is_root: bool
    is_result: bool
    seen: float
    said: float | None = None


class MissingData:
    """Records since when each item has been missing. One per node; thread-safe.

    Uses wall time, because a running simulated clock is one of the items that can be missing.
    """

    def __init__(self, patience: float = 1.0) -> None:
        """Nothing is logged in the first `patience` s of an absence."""
        self._patience = patience
        self._lock = threading.Lock()
        self._absent: dict[str, _Absence] = {}

    def missing(self, what: str, advice: str = "", patience: float | None = None,
                since: float | None = None, is_root: bool = False,
                is_result: bool = False) -> None:
        """Report that `what` ("laser scans on /scan") is still missing; call whenever noticed.

        If several callers miss it, the `advice` of the one with the least patience is logged.
        `since` (time.monotonic): set if earlier than the first call. While an item with `is_root`
        is missing, nothing else is logged: it follows from that. An item with `is_result` is not
        logged while another has been missing since about then, whatever its patience.
        """
        now = time.monotonic()
        patience = self._patience if patience is None else patience
        with self._lock:
            entry = self._absent.get(what)
            if entry is None or now - entry.seen > FORGOTTEN:
                entry = self._absent[what] = _Absence(now, patience, advice, is_root, is_result,
                                                      now)
            entry.since, entry.seen = min(entry.since, now if since is None else since), now
            if patience <= entry.patience:
                entry.patience, entry.advice = patience, advice
            line = self._line(now)
        if line:
            rospy.logwarn("%s", line)

    def present(self, what: str) -> None:
        """Report that `what` is there, which ends its absence."""
        with self._lock:
            entry = self._absent.pop(what, None)
        if entry is not None and entry.said is not None:
            rospy.loginfo("%s: there again", what)

    def _line(self, now: float) -> str:
        """The line to log now, or ""; a new absence does not wait for the INTERVAL of others."""
        known = self._known(now)
        new = {what: entry for what, entry in known.items() if entry.said is None}
        if new:
            gathering = all(now - entry.since < entry.patience + GATHERING
                            for entry in new.values())
            due = {} if gathering else new
        else:
            due = known if all(now - entry.said >= INTERVAL for entry in known.values()) else {}
        for entry in due.values():
            entry.said = now
        return "; ".join(f"no {what} for {now - entry.since:.0f} s"
                         + (f": {entry.advice}" if entry.advice else "")
                         for what, entry in due.items())

    def _known(self, now: float) -> dict[str, _Absence]:
        """What has been missing for longer than its patience, and follows from nothing else."""
        recent = {what: entry for what, entry in self._absent.items() if now - entry.seen <= RECENT}
        causes = [entry.since for entry in recent.values()
                  if not entry.is_result and now - entry.since >= self._patience]
        known = {what: entry for what, entry in recent.items()
                 if now - entry.since >= entry.patience and not (
                     entry.is_result and any(abs(entry.since - cause) < SOON for cause in causes))}
        return {what: entry for what, entry in known.items() if entry.is_root} or known
