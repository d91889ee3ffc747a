"""Messages that wait to be shown: for their turn, or for the transform of their frame."""

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

QUEUE = 10  # messages, as in rviz's message filter; older ones are dropped
QUEUE_OF_ALL = 2000  # for displays to which each message counts
MOST_BYTES = 32 << 20  # of raw messages, but the newest two stay


class Waiting:
    """A queue of raw messages, which are decoded when they are needed. Thread safe."""

    def __init__(self, every: bool, read: Callable[[Any], tuple[Any, str]]):
        self._queue: deque[list[Any]] = deque(maxlen=QUEUE_OF_ALL if every else QUEUE)
        self._lock = threading.Lock()
        self._read = read
        self.received = 0
        self.publisher = ""  # of the message that was read last

    def put(self, raw: Any) -> None:
        """Add a message."""
        with self._lock:
            self.received += 1
            self._queue.append([raw, None])
            size = sum(len(one._buff) for one, _ in self._queue)
            while size > MOST_BYTES and len(self._queue) > 2:
                size -= len(self._queue.popleft()[0]._buff)

    def put_back(self, raws: list[Any]) -> None:
        """Put messages that were shown already before those that wait."""
        with self._lock:
            self._queue.extendleft([raw, None] for raw in reversed(raws))

    def in_order(self) -> list[Any]:
        """Remove and return all raw messages, oldest first."""
        with self._lock:
            found = [raw for raw, _ in self._queue]
            self._queue.clear()
        return found

    def newest(self, ready: Callable[[Any], Any]) -> tuple[Any, tuple[Any, str], Any] | None:
        """The newest message for which `ready` raises no ValueError: raw, as read, and the result
        of `ready`; older ones are dropped. One that cannot be read is, too, and its error raised.

        If none is ready, the newest one's ValueError is raised.
        """
        with self._lock:
            entries = list(self._queue)
        problem = None
        for entry in reversed(entries):
            if entry[1] is None:
                self._read_entry(entry)
            try:
                found = ready(entry[1])
            except ValueError as error:
                problem = problem or error
                continue
            self._drop(entry)
            return entry[0], entry[1], found
        if problem is not None:
            raise problem
        return None

    def _read_entry(self, entry: list[Any]) -> None:
        try:
            entry[1] = self._read(entry[0])
        except Exception:
            self._drop(entry)
            raise
        self.publisher = entry[1][1]

    def _drop(self, last: list[Any]) -> None:
        """Remove this entry and all before it."""
        with self._lock:
            while self._queue:
                if self._queue.popleft() is last:
                    break
