"""What comes from outside and acts on the world: messages and requests, and who takes them."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any, NamedTuple

Take = Callable[[Any], Callable[[], Any] | None]


class Input(NamedTuple):
    """A message or a request that takes effect; `number` is that of its taker."""

    name: str  # of the topic or service
    number: int | None  # None: it cannot be repeated from its message
    message: Any = None
    called: bool = False  # whether by a service

    def serialized(self) -> bytes:
        """The message as it is sent."""
        buffer = io.BytesIO()
        self.message.serialize(buffer)
        return buffer.getvalue()


class Inputs:
    """Takers by topic or service: several plugins may subscribe to one topic.

    Takers are added in the loop's thread, in the same order in each run, and keep their numbers.
    """

    def __init__(self) -> None:
        self._takers: dict[str, list[tuple[type, Take] | None]] = {}

    def add(self, name: str, kind: type, take: Take) -> int:
        """A taker of messages of this type; returns its number.

        `take(message)` returns a function for the loop, or None.
        """
        takers = self._takers.setdefault(name, [])
        takers.append((kind, take))
        return len(takers) - 1

    def has(self, name: str) -> bool:
        """Whether anybody takes messages of that name."""
        return name in self._takers

    def remove(self, name: str, number: int) -> None:
        """That taker has ended."""
        takers = self._takers[name]
        takers[number] = None
        if not any(takers):
            del self._takers[name]

    def repeated(self, name: str, number: int, data: bytes) -> tuple[Input, Callable[[], Any]]:
        """A serialised message as an input, and what its taker wants done in the loop.

        LookupError if there is no such taker.
        """
        taker = self._takers[name][number]
        if taker is None:
            raise LookupError(name)
        kind, take = taker
        message = kind()
        message.deserialize(data)
        return Input(name, number, message), take(message) or (lambda: None)
