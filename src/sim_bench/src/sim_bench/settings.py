"""Settings of the parts: durations, output folder, progress callback."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Settings:
    """Of one run of the benchmark."""

    quick: bool  # few and short runs: shows that all works, not how fast
    memory_s: float  # simulated seconds of the part `memory`
    out: Path  # folder of results; logs of started programs go below it
    say: Callable[[str], None] = print  # a line for the person who waits

    def runs(self, usual: int) -> int:
        """How often to measure: `usual`, or 2 for a quick pass."""
        return 2 if self.quick else usual

    def seconds(self, usual: float) -> float:
        """How long to measure, s: `usual`, or a quarter of it for a quick pass."""
        return usual / 4 if self.quick else usual
