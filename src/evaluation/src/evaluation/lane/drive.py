"""Drives laps as `make lane` does, as fast as it goes, each seed with its own start and light."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bullet_sim.formats.resources import Resources
from evaluation.course_run.course_file import find_package
from evaluation.course_run.failure import RunError
from evaluation.course_run.processes import Family
from evaluation.race_trials.disturbance import Disturbance
from evaluation.race_trials.light import write_lit_world
from evaluation.track import load_track

LIGHT, NOISE = (0.6, 1.4), (0.0, 0.02)  # times the world's own; standard deviation, 1: full
START_OFFSET, START_TURN = 0.05, 0.1  # m and rad, to either side, at most
NEAR = 3.0  # m: people set off when the car is that near or nearer, so that they meet
LONGEST_LAP = 240.0  # s, simulated
STARTUP_LIMIT, LAP_LIMIT = 240.0, 1800.0  # s, wall: the machine may be busy
ANSWER_LIMIT = 20.0  # s, wall, for the node's answer: a busy machine must not change a drive
DRIVEN = (0, 1)  # exit codes of course_run after a drive
MODEL_PATH = "GAZEBO_MODEL_PATH"


@dataclass(frozen=True)
class Drive:
    """What to drive: a method's name, a seed, laps in a row, and whether people cross."""

    method: str
    seed: int
    laps: int
    people: bool

    @property
    def name(self) -> str:
        """Of its folder."""
        return f"{'people' if self.people else 'laps'}-{self.seed}"


def draw(seed: int) -> Disturbance:
    """The seed's start, noise and light, evenly distributed between the bounds above."""
    random = np.random.default_rng(seed)
    return Disturbance(
        sideways=random.uniform(-START_OFFSET, START_OFFSET),
        along=0.0,
        turn=random.uniform(-START_TURN, START_TURN),
        camera_noise=random.uniform(*NOISE),
        light=random.uniform(*LIGHT),
    )


def drive(what: Drive, out: Path) -> tuple[dict, Path]:
    """course_run's report, and the folder of the drive; RunError if nothing could be driven."""
    folder = out / what.name
    results = folder / what.method
    results.mkdir(parents=True, exist_ok=True)
    report = results / "report.json"
    report.unlink(missing_ok=True)
    disturbance = draw(what.seed)
    models = find_package("lane_keeping") / "models"
    world = models.parent / "worlds" / ("lane.world" if what.people else "lane_empty.world")
    sun = Resources.from_environment().resolve("model://sun")
    lit = write_lit_world(world, models, sun, disturbance.light, folder)
    paths = [folder / "models", models, os.environ.get(MODEL_PATH, "")]
    environment = {**os.environ, MODEL_PATH: ":".join(str(path) for path in paths if str(path))}
    with Family() as family:
        child = family.start("course_run", command(what, disturbance, lit, results), environment,
                             results / "course_run.log")
        try:
            child.process.wait(LAP_LIMIT * what.laps)
        except subprocess.TimeoutExpired as late:
            raise RunError(f"{results}: the drive does not end", child.last_lines()) from late
    if child.process.returncode not in DRIVEN or not report.exists():
        *details, why = child.last_lines().splitlines() or ["course_run said nothing"]
        raise RunError(f"{what.method}, seed {what.seed}: {why}", "\n".join(details))
    return json.loads(report.read_text(encoding="utf-8")), results


def command(what: Drive, disturbance: Disturbance, world: Path, results: Path) -> list[str]:
    """The command line of course_run for a drive in this world, with results in that folder."""
    evaluation = find_package("evaluation")
    x, y, yaw = disturbance.start(load_track(evaluation / "tracks" / "lane.yaml"))
    arguments = [
        f"world_name:={world}", f"x_pos:={x:.6f}", f"y_pos:={y:.6f}", f"yaw:={yaw:.6f}",
        f"camera_noise:={disturbance.camera_noise:.6f}", f"lockstep_timeout:={ANSWER_LIMIT:g}",
    ]  # fmt: skip
    launch = []
    if what.people:
        launch = ["--launch", "evaluation", "lane.launch"]
        arguments += [f"near:={NEAR:g}", f"record:={results / 'poses.txt'}"]
    return [
        sys.executable, "-P", str(evaluation / "scripts" / "course_run.py"),
        "--course", "lane" if what.people else "lane_empty", *launch,
        "--follower", f"{what.method}.py", "--laps", str(what.laps), "--fast", "--no-video",
        "--seed", str(what.seed), "--duration", f"{LONGEST_LAP * what.laps:g}",
        "--startup-timeout", f"{STARTUP_LIMIT:g}", "--out", str(results),
        *(word for argument in arguments for word in ("--launch-arg", argument)),
    ]  # fmt: skip
