"""The car's true poses, from the simulator's state log."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

STANDS, TURNS = 0.02, 0.05  # m/s, rad/s: less counts as standing still
STOP_TIME = 0.7  # s, simulated, within which a car without a driver must stop
SETTLED = 0.5  # s, simulated: a spawned car drops and rolls a little
Place = tuple[float, float, float, float]  # s, simulated; x, y, m; yaw, rad


def places(path: Path, robot: str) -> list[Place]:
    """All poses of the car, in order; an incomplete last line is ignored."""
    found = []
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines(keepends=True):
            if line.startswith('{"time"') and line.endswith("\n"):
                state = json.loads(line)
                if pose := state["poses"].get(robot):
                    yaw = 2 * math.atan2(pose[5], pose[6])
                    found.append((state["time"], pose[0], pose[1], yaw))
    return found


def moves(before: Place, after: Place) -> bool:
    """Whether it drove or turned between two places."""
    passed = max(after[0] - before[0], 1e-9)
    turn = abs(math.remainder(after[3] - before[3], math.tau))
    return math.dist(before[1:3], after[1:3]) > STANDS * passed or turn > TURNS * passed


def driven(seen: list[Place]) -> float:
    """Straight distance (m) since it settled after spawning."""
    settled = [place for place in seen if place[0] > seen[0][0] + SETTLED]
    return math.dist(settled[0][1:3], settled[-1][1:3]) if settled else 0.0


def drives_on(seen: list[Place], since: float, until: float) -> str | None:
    """An error if a car without a driver moves between these times, s; None: it stopped in time."""
    late = [place for place in seen if since + STOP_TIME <= place[0] <= until]
    for before, after in itertools.pairwise(late):
        if moves(before, after):
            return f"drives or turns {after[0] - since:.2f} s after its driver was gone"
    return None
