"""Measures wall time: a stopwatch for each stage of the work."""

import threading
import time
from collections import defaultdict
from contextlib import AbstractContextManager
from dataclasses import dataclass


@dataclass
class Stage:
    """The cost of one stage so far; wall time in s."""

    count: int = 0
    total: float = 0.0
    worst: float = 0.0


class _Inside(threading.local):
    """s of a thread, measured inside its current block."""

    seconds = 0.0


class Profiler:
    """Stages by name. Several threads may add at once, each to its own stages."""

    def __init__(self):
        self._stages: dict[str, Stage] = defaultdict(Stage)
        self._inside = _Inside()

    def add(self, name: str, seconds: float, count: int = 1) -> None:
        """Add `count` executions that took `seconds` of wall time together."""
        stage = self._stages[name]
        stage.count += count
        stage.total += seconds
        stage.worst = max(stage.worst, seconds / count)

    def measure(self, name: str) -> AbstractContextManager[None]:
        """Time the `with` block, without what is measured separately inside it."""
        return _Measured(self, name, self._inside)

    def totals(self) -> dict[str, float]:
        """Seconds of wall time by stage, since the start."""
        return {name: stage.total for name, stage in list(self._stages.items())}

    def table(self, elapsed: float) -> str:
        """A row for each stage, the costliest first; `elapsed` is the total wall time (s)."""
        head = f"{'stage':<12}{'times':>9}{'ms each':>10}{'worst ms':>10}{'share':>8}"
        rows = sorted(self._stages.items(), key=lambda item: -item[1].total)
        return "\n".join([head] + [
            f"{name:<12}{stage.count:>9}{stage.total / stage.count * 1e3:>10.3f}"
            f"{stage.worst * 1e3:>10.2f}{stage.total / elapsed:>8.1%}"
            for name, stage in rows
        ])


class _Measured(AbstractContextManager):
    """One block: a class, as a generator costs twice as much."""

    __slots__ = ("_profiler", "_name", "_inside", "_outer", "_start")

    def __init__(self, profiler: Profiler, name: str, inside: _Inside):
        self._profiler, self._name, self._inside = profiler, name, inside

    def __enter__(self) -> None:
        self._outer, self._inside.seconds = self._inside.seconds, 0.0
        self._start = time.perf_counter()

    def __exit__(self, *_: object) -> None:
        took = time.perf_counter() - self._start
        self._profiler.add(self._name, took - self._inside.seconds)
        self._inside.seconds = self._outer + took
