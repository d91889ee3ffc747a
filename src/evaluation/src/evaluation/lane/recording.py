"""True poses of car and people, as lines of a file, by which encounters are judged afterwards."""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass
from pathlib import Path

from run_session.failure import RunError

CAR = "car"


@dataclass(frozen=True)
class Moment:
    """One true pose: simulated s, m, rad, m/s."""

    time: float
    x: float
    y: float
    yaw: float
    speed: float


# In order of time, by name: CAR, and people by their models' names.
Recording = dict[str, list[Moment]]


def last(moments: list[Moment], time: float) -> Moment | None:
    """The last of them up to this time; None: there is none."""
    index = bisect.bisect_right(moments, time, key=lambda moment: moment.time)
    return moments[index - 1] if index else None


def line_of(name: str, moment: Moment) -> str:
    """The file's line for one moment."""
    return (f"{name} {moment.time:.3f} {moment.x:.4f} {moment.y:.4f} {moment.yaw:.4f} "
            f"{moment.speed:.4f}\n")


def read_recording(path: Path) -> Recording:
    """Read what `line_of` wrote; an incomplete last line is ignored."""
    found: Recording = {}
    try:
        lines = path.read_text(encoding="utf-8").split("\n")[:-1]
        for line in lines:
            name, *numbers = line.split()
            moment = Moment(*map(float, numbers))
            if not all(map(math.isfinite, (moment.time, moment.x, moment.y))):
                raise ValueError(line)
            found.setdefault(name, []).append(moment)
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}") from error
    except (TypeError, ValueError) as error:
        raise RunError(f"{path}: no recording of a drive: {error}") from error
    for moments in found.values():
        moments.sort(key=lambda moment: moment.time)
    return found
