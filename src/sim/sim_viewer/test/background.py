"""One asyncio loop in a thread, for tests that are plain functions."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable, Coroutine

LIMIT = 60.0  # s that anything may take

loop = asyncio.new_event_loop()
threading.Thread(target=loop.run_forever, daemon=True).start()


def run(work: Coroutine):
    """What a coroutine returns, run in the loop."""
    return asyncio.run_coroutine_threadsafe(work, loop).result(LIMIT)


def wait_until(condition: Callable[[], object], what: str, limit: float = LIMIT):
    """The condition's first true value."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.02)
    raise AssertionError(f"not within {limit} s: {what}")
