"""A queue of length one: a new item replaces an old one, and replaced ones are counted."""

from __future__ import annotations

import threading
from typing import Generic, TypeVar

T = TypeVar("T")


class Newest(Generic[T]):
    """Passes items from one thread to a slower one."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._item: T | None = None
        self._skipped = self._taken = 0

    def put(self, item: T) -> None:
        """Put the newest item; one that was not taken yet is skipped."""
        with self._changed:
            self._skipped += self._item is not None
            self._item = item
            self._changed.notify()

    def take(self, timeout: float) -> T | None:
        """The newest item, only once; None if none comes within `timeout`, wall s."""
        with self._changed:
            self._changed.wait_for(lambda: self._item is not None, timeout)
            item, self._item = self._item, None
            self._taken += item is not None
            return item

    def counts(self) -> tuple[int, int]:
        """How many were taken and how many skipped since the last call."""
        with self._changed:
            counts = self._taken, self._skipped
            self._taken = self._skipped = 0
            return counts
