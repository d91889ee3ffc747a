"""Queues of messages to one browser, limited so that a slow browser costs no memory."""

import asyncio
import json
import struct
from collections import deque
from typing import Any

MOST_ANSWERS = 100  # unread ones, after which nothing more is read from the browser
MOST_KEPT = 500  # messages of one watchable; the oldest is dropped first
MOST_BYTES = 4 << 20  # of one watch, likewise


class Outbox:
    """Answers in order; of each watchable the newest message, and those marked to be kept."""

    def __init__(self, loop: asyncio.AbstractEventLoop):
        self._loop = loop
        self._answers: deque[str] = deque()
        self._watched: dict[int, deque[tuple[bool, str | bytes]]] = {}
        self._something = asyncio.Event()
        self._has_space = asyncio.Event()
        self._has_space.set()
        self._ended = False

    def answer(self, message: dict[str, Any]) -> None:
        """Queue an answer; in the loop's thread."""
        self._answers.append(encode(message))
        self._something.set()
        if len(self._answers) >= MOST_ANSWERS and not self._ended:
            self._has_space.clear()

    async def wait_for_space(self) -> None:
        """Waits until the browser has read enough of its answers, or has disconnected."""
        await self._has_space.wait()

    def end(self) -> None:
        """Nothing will be sent any more."""
        self._ended = True
        self._has_space.set()

    def open(self, watch: int) -> None:
        """Accept messages of this watch from now on."""
        self._watched[watch] = deque(maxlen=MOST_KEPT)

    def close(self, watch: int) -> None:
        """Drop this watch's queued messages, and those that still come."""
        self._watched.pop(watch, None)

    def post(self, watch: int, data: Any, keep: bool) -> None:
        """Queue a watch's message; from any thread. Bytes are sent after the watch's number."""
        message = (struct.pack("<I", watch) + data if isinstance(data, bytes)
                   else encode({"watch": watch, "data": data}))
        try:
            self._loop.call_soon_threadsafe(self._put, watch, message, keep)
        except RuntimeError:
            pass  # the loop has ended

    def _put(self, watch: int, message: str | bytes, keep: bool) -> None:
        mail = self._watched.get(watch)
        if mail is None:
            return
        if mail and not keep and not mail[-1][0]:
            mail.pop()
        mail.append((keep, message))
        size = sum(len(one) for _, one in mail) if len(mail) > 1 else 0
        while size > MOST_BYTES:
            size -= len(mail.popleft()[1])
        self._something.set()

    async def next(self) -> str | bytes:
        """Waits for something to send; watches take turns."""
        while True:
            if self._answers:
                self._has_space.set()
                return self._answers.popleft()
            for watch, mail in self._watched.items():
                if mail:
                    message = mail.popleft()[1]
                    self._watched[watch] = self._watched.pop(watch)  # to the end of the queue
                    return message
            self._something.clear()
            await self._something.wait()


def encode(data: Any) -> str:
    """JSON that every browser reads: NaN and infinity become null."""
    try:
        return json.dumps(data, allow_nan=False, separators=(",", ":"))
    except ValueError:
        return json.dumps(_finite(data), allow_nan=False, separators=(",", ":"))


def _finite(data: Any) -> Any:
    if isinstance(data, float):
        return data if abs(data) < float("inf") else None
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_finite(value) for value in data]
    return data
