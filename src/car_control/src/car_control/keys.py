"""Which driving keys are down, from the events of a window or the characters of a terminal.

Neither tells it plainly: a window's X server sends a release and a press for each repetition of a
held key, and a terminal sends characters only, and those of the last key alone.
"""

from __future__ import annotations

import math
from collections.abc import Set

DRIVING_KEYS = frozenset("wasd")
STOP_KEY = " "
QUIT_KEY = "q"
OPPOSITE = {"w": "s", "s": "w", "a": "d", "d": "a"}

RELEASE_WAIT = 0.03  # s: a release that belongs to a repetition has its press within this
FIRST_WAIT = 0.7  # s from a key's character to its first repetition; X servers wait 0.66 at most
REPEAT_WAIT = 0.25  # s between two repetitions, slow ones (ssh) too


def command(keys: Set[str], speed: float, angle: float) -> tuple[float, float]:
    """Speed and steering angle (left positive) for the keys held; opposite ones cancel out."""
    forward = ("w" in keys) - ("s" in keys)
    left = ("a" in keys) - ("d" in keys)
    return forward * speed, left * angle


class WindowKeys:
    """Keys of a window; `wall` is any clock in s that only goes forward.

    A release counts only after RELEASE_WAIT without a press of the same key. The screen's key
    repetition stays as the person has it: it is one for all windows, and a program that is killed
    could not switch it on again.
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
        """The window lost the keyboard: from now on releases go elsewhere."""
        self._down.clear()
        self._released.clear()

    def held(self, wall: float) -> frozenset[str]:
        for key, when in list(self._released.items()):
            if wall - when >= RELEASE_WAIT:
                del self._released[key]
                self._down.discard(key)
        return frozenset(self._down)


class TerminalKeys:
    """Keys of a terminal: down while their characters keep coming.

    A second key silences the repetition of the first, so its characters keep the first alive too:
    W, then A beside it, drives a bend. When the last one is let go, all are.
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
    """When a command is sent: a new one at once, one that drives ten times a second.

    Standing is said for a moment and then no more, so that others can drive meanwhile.
    """

    PERIOD = 0.1  # s
    FAREWELL = 0.3  # s of zeros

    def __init__(self) -> None:
        self.sent = (0.0, 0.0)
        self._next = math.inf  # s: when the same command is sent again
        self._farewell_end = -math.inf

    def due(self, wanted: tuple[float, float], wall: float) -> bool:
        """Whether to send it now; if so it counts as sent."""
        if wanted != self.sent:
            self._next, self._farewell_end = wall, wall + self.FAREWELL
        elif wall < self._next or (wanted == (0.0, 0.0) and wall > self._farewell_end):
            return False
        self.sent, self._next = wanted, max(self._next + self.PERIOD, wall)
        return True
