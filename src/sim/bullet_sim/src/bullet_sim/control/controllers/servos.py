"""Several servos with one command: a single joint's controller has one of them."""

from __future__ import annotations

from collections.abc import Sequence

from bullet_sim.control.controllers.commands import Commands
from bullet_sim.control.controllers.servo import PositionServo, Servo


class Servos:
    """One target for each. A velocity falls back to 0 after a time-out, a position is held."""

    def __init__(self, servos: Sequence[Servo], timeout: float = 0.0):
        self.servos = servos
        self.commands = Commands(timeout)

    def start(self) -> None:
        """Keep everything as it is until a command comes."""
        rest = [servo.start() for servo in self.servos]
        holds = any(isinstance(servo, PositionServo) for servo in self.servos)
        self.commands.start(rest, None if holds else rest)

    def update(self, time: float, period: float) -> None:
        """Write the commands."""
        for servo, target in zip(self.servos, self.commands.at(time), strict=True):
            servo.update(target, period)
