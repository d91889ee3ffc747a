"""The simulator's state log and others, read while they grow."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from pathlib import Path

from evaluation.lap import Sample

STATE_LOG = "state.jsonl"


class Tail:
    """Whole new lines of a file that grows."""

    def __init__(self, path: Path):
        self.path, self.read, self._rest = path, 0, b""  # bytes read

    def lines(self) -> list[str]:
        """Those since the last call; none of a file that is not there."""
        try:
            with self.path.open("rb") as file:
                file.seek(self.read)
                data = file.read()
        except FileNotFoundError:
            return []
        self.read += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [line.decode("utf-8", "replace") for line in lines]

    def skip(self) -> None:
        """Leave out what is there."""
        self.lines()


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
