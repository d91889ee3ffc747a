"""Knows when nothing moves: then a step would only repeat the one before, and is left out.

Engines call this auto-disabling; ODE does it below 0.01 m/s and 0.01 rad/s. Ours is stricter, and
for the world as a whole: one thing that moves, or a motor that wants to, and everything is solved.
"""

from __future__ import annotations

from typing import Protocol

STILL_SPEED = 2e-4  # m/s; contacts alone leave a standing robot creeping at 1.5e-5 (measured)
STILL_RATE = 5e-3  # rad/s; contacts alone leave 2e-4 of a robot, 1.4e-3 of its wheels (measured)
LOOK_EVERY = 50  # steps
LOOKS = 10  # in a row that have to find everything still


class Restable(Protocol):
    """A body as seen from here."""

    def wants_to_move(self) -> bool:
        """Whether a motor has somewhere to go."""
        ...

    def speeds(self) -> tuple[float, float]:
        """Greatest speed, m/s, and rate of turn, rad/s, of any of its parts."""
        ...


class Rest:
    """Asked before every step. What is changed from outside, by anybody, ends the rest."""

    def __init__(self):
        self.bodies: list[Restable] = []
        self.disturb()

    def disturb(self) -> None:
        """Something was changed: a motor, a pose, gravity, what there is."""
        self._steps = self._looks = 0

    @property
    def reached(self) -> bool:
        """Whether the next step would change nothing."""
        return self._looks >= LOOKS

    def step_needed(self) -> bool:
        """Whether the next step would do anything; to be asked before each."""
        if self._looks >= LOOKS:
            return False
        self._steps += 1
        if self._steps % LOOK_EVERY == 0:
            self._looks = self._looks + 1 if self._all_still() else 0
        return True

    def _all_still(self) -> bool:
        return all(_is_still(body) for body in self.bodies)


def _is_still(body: Restable) -> bool:
    if body.wants_to_move():
        return False
    speed, rate = body.speeds()
    return speed < STILL_SPEED and rate < STILL_RATE
