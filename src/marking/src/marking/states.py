"""The simulator's state log, and how much was written beside it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from pathlib import Path

from evaluation.lap import Sample

STATE_LOG = "state.jsonl"


def bytes_below(folder: Path) -> int:
    """Of all files of a folder, while others write there."""
    total = 0
    for path in folder.rglob("*"):
        with contextlib.suppress(FileNotFoundError):
            total += path.lstat().st_size
    return total


def sample_of(entry: dict, robot: str) -> Sample | None:
    """Where the robot was, from a line of the state log; None: it is not of that."""
    pose: Sequence[float] | None = entry.get("poses", {}).get(robot)
    if pose is None:
        return None
    x, y, _, qx, qy, qz, qw = pose
    yaw = math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
    return Sample(entry["time"], x, y, yaw)
