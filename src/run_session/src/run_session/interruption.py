"""Ctrl-C, SIGTERM and SIGHUP as an exception that is raised once."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """The first of these signals raises KeyboardInterrupt; later ones do not disturb the cleanup.

    Used again within it, the inner block can be interrupted once more.
    """

    def interrupt(_number: int, _frame: object) -> None:
        for number in caught:
            signal.signal(number, signal.SIG_IGN)
        raise KeyboardInterrupt

    caught = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    for number in caught:
        signal.signal(number, interrupt)
    yield
