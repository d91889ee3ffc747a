"""Where laps are driven: the racetrack, and random tracks that make_track makes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from evaluation.laps.lap_trial import Venue
from run_session.failure import RunError
from run_session.resources import find_package

LIMIT = 120.0  # s, wall, for making one track


def racetrack() -> Venue:
    """The one in racecar_description."""
    return _venue("racetrack", find_package("racecar_description"))


def random_track(seed: int, out: Path) -> Venue:
    """The seed's track, made anew below `out`."""
    name = f"random_{seed}"
    script = find_package("racecar_description") / "scripts" / "make_track"
    command = [sys.executable, "-P", str(script), "--random", str(seed), "--name", name]
    done = subprocess.run(
        [*command, "--out", str(out)], capture_output=True, text=True, timeout=LIMIT, check=False
    )
    if done.returncode:
        raise RunError(f"no track of seed {seed}", done.stderr.strip())
    return _venue(name, out)


def _venue(name: str, root: Path) -> Venue:
    return Venue(root / "worlds" / f"{name}.world", root / "tracks" / f"{name}.yaml",
                 root / "models")
