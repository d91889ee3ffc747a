"""The dead man's switch of one command topic: who holds it, until when, and what to publish.

No ROS, no thread and no clock: `now` is passed in, in seconds of a monotonic clock.
"""

import math
from collections.abc import Hashable
from dataclasses import dataclass

HOLD = 0.25  # s that a command lasts; the page repeats a held key at 10 Hz


@dataclass(frozen=True)
class Command:
    """The command of a held key. Positive: forwards, and to the left."""

    linear: float  # m/s
    angular: float  # rad/s; for a car the steering angle in rad


STOP = Command(0.0, 0.0)


class DrivenByAnother(Exception):
    """Another client drives now; this one must release its keys before it may drive again."""


class DeadMan:
    """One topic with one driver. Each method returns the commands to publish now, oldest first."""

    def __init__(self, hold: float = HOLD) -> None:
        self._hold = hold
        self.driver: Hashable | None = None
        # When `expire` has a command to publish, s; infinite while nobody drives.
        self.until = math.inf
        self._moving = False  # whether the last published command was not a stop
        self._last: Hashable | None = None  # who drove last, until it releases
        self._ousted: set[Hashable] = set()  # earlier drivers that have not released

    def press(self, client: Hashable, command: Command, now: float) -> list[Command]:
        """A command of a client. The latest client becomes the driver, beginning with a stop.

        So two people never drive one robot in turn: the earlier driver, also one whose command
        expired, gets DrivenByAnother until it releases its keys.
        """
        if client in self._ousted:
            raise DrivenByAnother
        if self._last not in (None, client):
            self._ousted.add(self._last)
        self._last = client
        due = self.expire(now)
        taken = self.driver not in (None, client)
        self.driver, self.until = client, now + self._hold
        return self._stop() if taken else [*due, *self._go(command)]

    def release(self, client: Hashable) -> list[Command]:
        """The client released its keys, or disconnected."""
        self._ousted.discard(client)
        if client == self._last:
            self._last = None
        return self._let_go() if client == self.driver else []

    def expire(self, now: float) -> list[Command]:
        """Stop if the driver has sent nothing for the length of a command."""
        return self._let_go() if now >= self.until else []

    def _let_go(self) -> list[Command]:
        self.driver, self.until = None, math.inf
        return self._stop()

    def _stop(self) -> list[Command]:
        stops = [STOP] if self._moving else []
        self._moving = False
        return stops

    def _go(self, command: Command) -> list[Command]:
        self._moving = command != STOP
        return [command]
