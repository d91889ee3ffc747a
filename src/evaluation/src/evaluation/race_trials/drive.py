"""Drives one lap as `make race` does, as fast as it goes, and reads what became of it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from bullet_sim.formats.resources import Resources
from evaluation.course_run.course_file import find_package
from evaluation.course_run.failure import RunError
from evaluation.course_run.processes import Child, Family
from evaluation.race_trials.disturbance import Disturbance
from evaluation.race_trials.light import write_lit_world
from evaluation.race_trials.results import Lap, lap_from_report
from evaluation.race_trials.venue import Venue
from evaluation.track import load_track

LONGEST_LAP = 120.0  # s, simulated
STARTUP_LIMIT, LIMIT = 120.0, 1200.0  # s, wall
ANSWER_LIMIT = 10.0  # s, wall, for the follower's answer: a busy machine must not change a drive
DRIVEN = (0, 1)  # exit codes of course_run after a drive
MODEL_PATH = "GAZEBO_MODEL_PATH"


def drive(venue: Venue, seed: int, disturbance: Disturbance, follower: str, out: Path) -> Lap:
    """One lap below the folder `out`; RunError if it could not be driven at all."""
    folder = out / f"{venue.name}-{seed}"
    results = folder / Path(follower).stem
    results.mkdir(parents=True, exist_ok=True)
    sun = Resources.from_environment().resolve("model://sun")
    world = write_lit_world(venue.world, venue.models, sun, disturbance.light, folder)
    report = results / "report.json"
    report.unlink(missing_ok=True)
    models = [folder / "models", venue.models, os.environ.get(MODEL_PATH, "")]
    environment = {**os.environ, MODEL_PATH: ":".join(str(path) for path in models if str(path))}
    command = course_command(venue, seed, disturbance, world)
    with Family() as family:
        child = family.start(
            "course_run", [*command, "--follower", follower, "--out", str(results)],
            environment, results / "course_run.log",
        )  # fmt: skip
        _wait(child)
    if child.process.returncode not in DRIVEN or not report.exists():
        code = child.process.returncode
        *details, why = child.last_lines().splitlines() or [f"course_run.py ended with {code}"]
        raise RunError(f"{follower} on {venue.name}, seed {seed}: {why}", "\n".join(details))
    values = json.loads(report.read_text(encoding="utf-8"))
    return lap_from_report(values, venue, seed, disturbance, results)


def course_command(
    venue: Venue, seed: int, disturbance: Disturbance, world: Path
) -> list[str]:
    """The command line of course_run, but for follower and results."""
    x, y, yaw = disturbance.start(load_track(venue.track))
    noise = disturbance.camera_noise
    arguments = (
        f"world_name:={world}", f"x_pos:={x:.6f}", f"y_pos:={y:.6f}", f"yaw:={yaw:.6f}",
        f"camera_noise:={noise:.6f}", f"lockstep_timeout:={ANSWER_LIMIT:g}",
    )  # fmt: skip
    script = find_package("evaluation") / "scripts" / "course_run.py"
    return [
        sys.executable, "-P", str(script), "--course", "race", "--track", str(venue.track),
        "--fast", "--no-video", "--seed", str(seed), "--duration", f"{LONGEST_LAP:g}",
        "--startup-timeout", f"{STARTUP_LIMIT:g}",
        *(word for argument in arguments for word in ("--launch-arg", argument)),
    ]  # fmt: skip


def _wait(child: Child) -> None:
    try:
        child.process.wait(LIMIT)
    except subprocess.TimeoutExpired as late:
        raise RunError(f"a lap did not end within {LIMIT:.0f} s", child.last_lines()) from late
