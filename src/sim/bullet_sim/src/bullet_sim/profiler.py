"""Measures wall time: a stopwatch for each stage of the work."""

import threading
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass
class Stage:
    """The cost of one stage so far; wall time in s."""

    count: int = 0
    total: float = 0.0
    worst: float = 0.0


class Profiler:
    """Stages by name. Several threads may add at once, each to its own stages."""

    def __init__(self):
        self._stages: dict[str, Stage] = defaultdict(Stage)
        self._thread = threading.local()

    def add(self, name: str, seconds: float, count: int = 1) -> None:
        """Add `count` executions that took `seconds` of wall time together."""
        stage = self._stages[name]
        stage.count += count
        stage.total += seconds
        stage.worst = max(stage.worst, seconds / count)

    @contextmanager
    def measure(self, name: str) -> Iterator[None]:
        """Time the `with` block, without what is measured separately inside it."""
        outer = getattr(self._thread, "inside", 0.0)
        self._thread.inside = 0.0  # s, of this thread, measured inside the current block
        start = time.perf_counter()
        try:
            yield
        finally:
            took = time.perf_counter() - start
            self.add(name, took - self._thread.inside)
            self._thread.inside = outer + took

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
