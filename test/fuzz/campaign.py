"""Tries a target with many inputs, and keeps what it finds."""

from __future__ import annotations

import re
import time
from pathlib import Path

import hypothesis
from hypothesis import HealthCheck, Phase, settings
from hypothesis.configuration import set_hypothesis_home_dir
from sandbox import Sandbox
from target import ROOT, Target

set_hypothesis_home_dir(ROOT / "out" / "fuzz" / ".hypothesis")  # else in the folder of the caller


class Report:
    """What came of one target; each kind of finding is kept once."""

    def __init__(self, target: Target, out: Path) -> None:
        self.target, self.inputs, self.seconds = target, 0, 0.0
        self.findings: dict[str, str] = {}  # kind -> the line
        self.sandbox = Sandbox(target)
        self._out = out / target.name

    def take(self, seed: int, content: bytes) -> None:
        """Try one input."""
        self.inputs += 1
        fault = self.sandbox.fault(content)
        kind = fault and re.sub(r"[\d.]+|'[^']*'|\".*", "", fault)
        if kind is None or kind in self.findings:
            return
        self._out.mkdir(parents=True, exist_ok=True)
        file = self._out / f"{seed}-{self.inputs}-{self.target.file}"
        file.write_bytes(content)
        shown = file.relative_to(ROOT) if file.is_relative_to(ROOT) else file
        self.findings[kind] = (f"{self.target.name}: {fault}; again: make fuzz "
                               f"TARGET={self.target.name} INPUT={shown}")
        print(self.findings[kind], flush=True)

    def row(self) -> str:
        """For the table at the end."""
        rate = self.inputs / self.seconds if self.seconds else 0.0
        return f"{self.target.name:12} {self.inputs:8} {rate:9.1f} {len(self.findings):9}"

    def close(self) -> None:
        self.sandbox.close()


def run(report: Report, seed: int, examples: int) -> None:
    """So many inputs by this seed: the same seed, the same inputs."""
    began = time.monotonic()

    @hypothesis.seed(seed)
    @settings(max_examples=examples, database=None, deadline=None, phases=[Phase.generate],
              suppress_health_check=list(HealthCheck))
    @hypothesis.given(report.target.inputs)
    def attempt(content: bytes) -> None:
        report.take(seed, content)

    attempt()
    report.seconds += time.monotonic() - began


def replay(target: Target, content: bytes) -> str | None:
    """What is wrong with one input, if anything."""
    sandbox = Sandbox(target)
    try:
        return sandbox.fault(content)
    finally:
        sandbox.close()
