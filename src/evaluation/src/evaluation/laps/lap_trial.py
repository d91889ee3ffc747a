"""A trial whose cases are drives of course_run, each with light, noise and a start of its own."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from racecar_description.track.closed_line import load_track

from evaluation.laps import lit_drive
from evaluation.laps.disturbance import Disturbance
from evaluation.trial.protocol import Case, ReportedTrial
from run_session.session import Session

# s, wall: the machine may be busy, and must not change a drive
STARTUP_LIMIT, LAP_LIMIT, ANSWER_LIMIT = 240.0, 1800.0, 20.0


@dataclass(frozen=True)
class Outing:
    """One drive of course_run."""

    what: str  # for messages
    course: str
    follower: str
    track: Path
    world: Path
    models: Path  # of the world
    lit: Path     # folder for the world in its own light
    out: Path     # folder for results
    disturbance: Disturbance
    longest: float  # s, simulated, a lap
    laps: int = 1
    options: tuple[str, ...] = ()  # more of course_run's
    launch: tuple[str, ...] = ()   # more for the launch file

    def arguments(self, seed: int, world: Path) -> list[str]:
        """Those of course_run, but for where results go."""
        start, noise = self.disturbance.start(load_track(self.track)), self.disturbance.camera_noise
        return ["--course", self.course, "--track", str(self.track), "--follower", self.follower,
                "--laps", str(self.laps), "--fast", "--no-video", "--seed", str(seed),
                "--duration", f"{self.longest * self.laps:g}",
                "--startup-timeout", f"{STARTUP_LIMIT:g}", *self.options,
                *lit_drive.launch_arguments(world, start, noise, ANSWER_LIMIT, *self.launch)]


class LapTrial(ReportedTrial):
    """Sets up and runs; what a drive is worth is for the trial to say."""

    @abstractmethod
    def outing(self, out: Path, case: Any) -> Outing:
        """The case's drive; folders lie below `out`."""

    def setup(self, session: Session, case: Case) -> None:
        self._case, outing = case, self.outing(session.out, case)
        self._outing = outing
        world = lit_drive.write_world(
            outing.world, outing.models, outing.disturbance.light, outing.lit)
        self._drive = lit_drive.start(session, outing.arguments(case.seed, world), outing.out,
                                      [outing.lit / "models", outing.models])

    def run(self) -> dict:
        """course_run's report."""
        return self._drive.report(LAP_LIMIT * self._outing.laps, self._outing.what)
