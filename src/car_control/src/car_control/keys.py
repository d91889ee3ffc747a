"""Which driving keys are held, from a window's events or a terminal's characters.

Neither reports it directly: the X server sends a release and a press for each repetition of a held
key, and a terminal sends only characters, and repeats only those of the last key.
"""

from __future__ import annotations

import math
from collections.abc import Set

DRIVING_KEYS = frozenset("wasd")
STOP_KEY = " "
QUIT_KEY = "q"
OPPOSITE = {"w": "s", "s": "w", "a": "d", "d": "a"}

RELEASE_WAIT = 0.03  # s within which a repetition's release is followed by its press
FIRST_WAIT = 0.7  # s from a key's character to its first repetition; X servers wait 0.66 at most
REPEAT_WAIT = 0.25  # s between two repetitions, even slow ones (ssh)


def command(keys: Set[str], speed: float, angle: float) -> tuple[float, float]:
    """Speed and steering angle (left positive) for the keys held; opposite ones cancel out."""
    forward = ("w" in keys) - ("s" in keys)
    left = ("a" in keys) - ("d" in keys)
    return forward * speed, left * angle


class WindowKeys:
    """A window's keys; `wall` is any monotonic clock in s.

    A release only counts after RELEASE_WAIT without a press of the same key. The screen's key
    repetition is not switched off: it is shared by all windows, and a killed program could not
    switch it on again.
    """

    def __init__(self) -> None:
        self._down: set[str] = set()
        self._released: dict[str, float] = {}  # key: when

    def press(self, key: str) -> None:
        self._down.add(key)
        self._released.pop(key, None)

    def release(self, key: str, wall: float) -> None:
        if key in self._down:
            self._released.setdefault(key, wall)

    def release_all(self) -> None:
        """The window lost the focus: releases will not be reported to it."""
        self._down.clear()
        self._released.clear()

    def held(self, wall: float) -> frozenset[str]:
        for key, when in list(self._released.items()):
            if wall - when >= RELEASE_WAIT:
                del self._released[key]
                self._down.discard(key)
        return frozenset(self._down)


class TerminalKeys:
    """A terminal's keys: held while their characters keep coming.

    A second key stops the repetition of the first, so its characters keep the first one held too:
    W, then also A, drives a bend. When the last one is released, all are.
    """

    def __init__(self) -> None:
        self._down: set[str] = set()
        self._last = ""
        self._until = 0.0

    def press(self, key: str, wall: float) -> None:
        held = self.held(wall)
        repeated = key == self._last and key in held
        self._down = set(held - {OPPOSITE[key]}) | {key}
        self._until = wall + (REPEAT_WAIT if repeated else FIRST_WAIT)
        self._last = key

    def release_all(self) -> None:
        self._down.clear()

    def held(self, wall: float) -> frozenset[str]:
        if wall >= self._until:
            self._down.clear()
        return frozenset(self._down)


class Pace:
    """When to send a command: a new one at once; while driving, ten times a second.

    A stop is only repeated for a moment, so that other nodes can drive afterwards.
    """

    PERIOD = 0.1  # s
    FAREWELL = 0.3  # s of zeros

    def __init__(self) -> None:
        self.sent = (0.0, 0.0)
        self._next = math.inf  # s, when to send the same command again
        self._farewell_end = -math.inf

    def due(self, wanted: tuple[float, float], wall: float) -> bool:
        """Whether to send it now; if so, it counts as sent."""
        if wanted != self.sent:
            self._next, self._farewell_end = wall, wall + self.FAREWELL
        elif wall < self._next or (wanted == (0.0, 0.0) and wall > self._farewell_end):
            return False
        self.sent, self._next = wanted, max(self._next + self.PERIOD, wall)
        return True
