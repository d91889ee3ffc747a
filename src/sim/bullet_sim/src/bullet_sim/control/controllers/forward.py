"""Passes commands on to the joints unchanged."""

from collections.abc import Sequence

from bullet_sim.control.controllers.commands import Commands
from bullet_sim.control.handles import CommandHandle


class Forward:
    """One number for each joint. Starts at rest: no effort, no speed, the current positions."""

    def __init__(self, handles: Sequence[CommandHandle], timeout: float = 0.0):
        self._handles = handles
        self.commands = Commands(timeout)

    def start(self) -> None:
        """Rest until a command comes, and after its time-out; a position is held."""
        for handle in self._handles:
            handle.rest()
        rest = [handle.command for handle in self._handles]
        holds = any(handle.interface == "position" for handle in self._handles)
        self.commands.start(rest, None if holds else rest)

    def update(self, time: float, period: float) -> None:
        """Write the commands."""
        for handle, value in zip(self._handles, self.commands.at(time), strict=True):
            handle.command = value
