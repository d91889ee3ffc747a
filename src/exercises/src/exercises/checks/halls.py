"""Driving by laser through halls with columns: command(angles, ranges), by a robot without slip."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from learning_laser import hall

from exercises.finding import Finding, at_least
from exercises.program import load, numbers, part

CALL = "command(angles, ranges)"


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """It must reach the finish in each hall without touching anything."""
    command = part(load(file), CALL)
    drives = [hall.drive(lambda *scan: numbers(command(*scan), 2, CALL), seed, limits["seconds"])
              for seed in range(round(limits["halls"]))]
    yield at_least("halls with the finish reached", sum(time is not None for time, _ in drives),
                   limits["halls"])
    yield at_least("least clearance of the robot's body", min(air for _, air in drives), 0.0, " m")
