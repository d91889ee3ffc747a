"""The simulator's state log, and the size of log folders."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from pathlib import Path

from evaluation.lap import Sample

STATE_LOG = "state.jsonl"


def bytes_below(folder: Path) -> int:
    """Total size of a folder's files, while other processes write there."""
    total = 0
    for path in folder.rglob("*"):
        with contextlib.suppress(FileNotFoundError):
            total += path.lstat().st_size
    return total


def sample_of(entry: dict, robot: str) -> Sample | None:
    """The robot's pose from an entry of the state log; None if it has none."""
    pose: Sequence[float] | None = entry.get("poses", {}).get(robot)
    if pose is None:
        return None
    x, y, _, qx, qy, qz, qw = pose
    yaw = math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
    return Sample(entry["time"], x, y, yaw)
