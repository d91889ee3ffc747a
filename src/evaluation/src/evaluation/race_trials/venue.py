"""Where laps are driven: the racetrack, and random tracks that make_track makes."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from run_session.failure import RunError
from run_session.resources import find_package

PACKAGE = "racecar_description"
RACETRACK, RANDOM_TRACKS = "racetrack", "random tracks"  # the two sets of laps
LIMIT = 120.0  # s, wall, for making one track


@dataclass(frozen=True)
class Venue:
    """One track and what belongs to it."""

    set: str
    name: str
    world: Path
    track: Path  # YAML of its centre line
    models: Path  # folder of the world's own models


def racetrack() -> Venue:
    """The one in racecar_description."""
    return _venue(RACETRACK, "racetrack", find_package(PACKAGE))


def random_track(seed: int, out: Path) -> Venue:
    """The seed's track, made anew below `out`."""
    name = f"random_{seed}"
    script = find_package(PACKAGE) / "scripts" / "make_track"
    command = [sys.executable, "-P", str(script), "--random", str(seed), "--name", name]
    done = subprocess.run(
        [*command, "--out", str(out)], capture_output=True, text=True, timeout=LIMIT, check=False
    )
    if done.returncode:
        raise RunError(f"no track of seed {seed}", done.stderr.strip())
    return _venue(RANDOM_TRACKS, name, out)


def _venue(kind: str, name: str, root: Path) -> Venue:
    world, track = root / "worlds" / f"{name}.world", root / "tracks" / f"{name}.yaml"
    return Venue(kind, name, world, track, root / "models")
