"""Calls in processes of their own: OpenGL contexts stay apart, and a crash ends no benchmark."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

from bullet_sim.physics.engine import STDOUT
from run_session.failure import RunError
from sim_bench.settings import say

LIMIT = 120  # s, wall, for one call
T = TypeVar("T")


class OwnProcess:
    """`count` processes that do the same at once; a context manager."""

    def __init__(self, what: str, count: int = 1):
        """`what`: its name in an error."""
        self._what, self._count = what, count
        self._pool = ProcessPoolExecutor(
            count, multiprocessing.get_context("spawn"), initializer=_prepare)

    def __enter__(self) -> OwnProcess:
        return self

    def __exit__(self, *_: object) -> None:
        self._pool.shutdown(cancel_futures=True)

    def call(self, function: Callable[..., T], *arguments: object) -> list[T]:
        """What each process returns; RunError where one fails, dies or takes too long."""
        try:
            asked = [self._pool.submit(_within_limit, function, arguments)
                     for _ in range(self._count)]
            return [each.result() for each in asked]
        except BrokenProcessPool:
            why = f"it died, or took more than {LIMIT} s"
        except (RunError, OSError) as error:
            why = str(error)
        raise RunError(f"{self._what}: {why}")


class Contest(contextlib.ExitStack):
    """Contenders that take turns, each in processes of its own; the first of them is ours."""

    def __init__(self, says: Mapping[str, str], count: int = 1):
        """`says`: their names in an error; `count`: processes of each, which work at once."""
        super().__init__()
        self._ours = next(iter(says))
        self._processes = {kind: self.enter_context(OwnProcess(name, count))
                           for kind, name in says.items()}

    def turn(self, function: Callable[..., T], *arguments: object) -> dict[str, list[T]]:
        """What function(kind, *arguments) returns in each process of each contender.

        One of the others that cannot is left out from then on, with a line; RunError if we cannot.
        """
        found = {}
        for kind in list(self._processes):
            try:
                found[kind] = self._processes[kind].call(function, kind, *arguments)
            except RunError as error:
                if kind == self._ours:
                    raise
                say(f"left out: {error}")
                del self._processes[kind]
        return found


def _prepare() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C: just end
    os.dup2(os.open(os.devnull, os.O_WRONLY), STDOUT)  # PyBullet's plugin prints while it draws


def _within_limit(function: Callable[..., T], arguments: tuple) -> T:
    """What it returns; RunError, which can be sent to the caller, whatever it raises."""
    signal.alarm(LIMIT)  # ends the process, even one that hangs in a driver
    try:
        return function(*arguments)
    except Exception as error:
        raise RunError(" ".join(str(error).split()) or type(error).__name__) from None
    finally:
        signal.alarm(0)
