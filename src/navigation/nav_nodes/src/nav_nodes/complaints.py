"""Lines that say what is missing and for how long, at most every 5 s each."""

from __future__ import annotations

import threading
import time

import rospy

INTERVAL = 5.0  # s of wall time between two lines of one kind


class Complaints:
    """Remembers since when each thing has been missing. Safe on any thread.

    Wall time, because a simulated clock that stands still is one of the things that can be missing.
    """

    def __init__(self, patience: float = 1.0) -> None:
        """Nothing is said in the first `patience` s of an absence."""
        self._patience = patience
        self._lock = threading.Lock()
        self._since: dict[str, float] = {}
        self._said: dict[str, float] = {}

    def missing(self, what: str, advice: str = "") -> None:
        """`what` ("laser scans on /scan") is still missing; call as often as that is noticed."""
        now = time.monotonic()
        with self._lock:
            since = self._since.setdefault(what, now)
            if now - since < self._patience or now - self._said.get(what, -INTERVAL) < INTERVAL:
                return
            self._said[what] = now
        tail = f": {advice}" if advice else ""
        rospy.logwarn("no %s for %.0f s%s", what, now - since, tail)

    def present(self, what: str) -> None:
        """It is there: the next absence begins anew."""
        with self._lock:
            self._since.pop(what, None)
            said = self._said.pop(what, None)
        if said is not None:
            rospy.loginfo("%s: there again", what)
