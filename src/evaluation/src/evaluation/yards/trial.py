"""`make navigation-trials`: move_base without a map through narrow yards and past people."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from evaluation.trial.command_line import Parser
from evaluation.trial.protocol import ReportedTrial
from evaluation.trial.report import grouped, table_of
from evaluation.yards import outcomes
from evaluation.yards.drive import YardCase, drive, prepare, task_of
from evaluation.yards.judge import Judge
from evaluation.yards.outcomes import CROSSINGS, YARDS, Drive
from evaluation.yards.pictures import write_chart, write_sheets
from evaluation.yards.rig import Rig
from run_session.failure import RunError
from run_session.resources import find_package
from run_session.session import Session
from trial_worlds.models import world, yard_model
from trial_worlds.yard import RADIUS, draw_yard

PARAMETERS = Path("config") / "yard.yaml"


class YardTrial(ReportedTrial):
    """All drives run in one simulator, which is started for the first of them."""

    program = "navigation_trials"
    does = ("Drive the waffle by move_base, without a map, through narrow yards and past persons"
            " who cross its way.")
    good = "at least 95 %% of the yards crossed and no person touched"
    writes = "report.json, report.html, pictures, worlds and drives"
    result, derived, shared = Drive, ("score",), ("parameters",)

    def __init__(self) -> None:
        self._rig: Rig | None = None

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--yards", 50, "narrow worlds")
        parser.add_whole("--first-yard", 0, "seed of the first of them")
        parser.add_whole("--repeats", 2, "drives through each of them")
        parser.add_whole("--crossings", 20, "drives past a person")
        parser.add_whole("--first-crossing", 0, "seed of the first of them")
        parser.add_pace("how fast simulated time shall go (1)")
        parser.add_argument("--parameters", type=Path, metavar="FILE", help="of move_base, over"
                            f" turtlebot3_navigation's (evaluation/{PARAMETERS})")

    def check(self, options: argparse.Namespace) -> None:
        if not (options.yards and options.repeats) and not options.crossings:
            raise RunError("no yards or repeats, and no crossings: nothing to drive")
        options.parameters = (
            options.parameters or find_package("evaluation") / PARAMETERS).resolve()
        if not options.parameters.is_file():
            raise RunError(f"--parameters {options.parameters}: no such file")
        self._make_rig = partial(Rig, real_time_factor=options.real_time_factor,
                                 parameters=options.parameters)

    def cases(self, options: argparse.Namespace) -> list[YardCase]:
        yards = range(options.first_yard, options.first_yard + options.yards)
        crossings = range(options.first_crossing, options.first_crossing + options.crossings)
        trials = [(YARDS, seed, repeat) for repeat in range(options.repeats) for seed in yards]
        trials += [(CROSSINGS, seed, 0) for seed in crossings]
        return [YardCase("-".join(map(str, each)), *each) for each in trials]

    def setup(self, session: Session, case: YardCase) -> None:
        if self._rig is None:
            self._rig = self._make_rig(session.launched("robot"))
        self._out, self._case, self._task = session.out, case, task_of(case)
        if case.set == YARDS:
            path = session.out / "worlds" / f"yard_{case.seed}.world"
            path.parent.mkdir(exist_ok=True)
            path.write_text(world(yard_model(draw_yard(case.seed))), encoding="utf-8")
        prepare(self._rig, self._task)

    def run(self) -> Drive:
        """Run the drive; its path is written below drives/."""
        judge = Judge(self._task.cylinders, RADIUS)
        drove = drive(self._rig, self._task, judge)
        path = self._out / "drives" / f"{self._case.name}.json"
        path.parent.mkdir(exist_ok=True)
        rounded = [[round(value, 4) for value in place] for place in judge.path]
        path.write_text(json.dumps(rounded) + "\n", encoding="utf-8")
        return drove

    def passed(self, results: Sequence[Drive]) -> bool:
        """Whether enough goals were reached, and the robot, while moving, touched nobody."""
        touched = any(d.set == CROSSINGS and d.outcome == outcomes.CONTACT for d in results)
        sets = grouped((d for d in results if d.outcome != outcomes.WALKED_INTO), lambda d: d.set)
        shares = [sum(d.reached for d in found) / len(found) for found in sets.values()]
        return not touched and min(shares, default=1.0) >= outcomes.LEAST_SHARE

    def table(self, results: Sequence[Drive]) -> str:
        return table_of(outcomes.COLUMNS, outcomes.summarize(results), left=())

    def values(self, results: Sequence[Drive]) -> dict:
        return {
            "least_share_of_yards": outcomes.LEAST_SHARE,
            "passed": self.passed(results),
            "summaries": outcomes.summarize(results),
            **super().values(results),
        }

    def pictures(self, results: Sequence[Drive], out: Path) -> list[str]:
        write_chart(results, out / "trials.png")
        return ["trials.png", *write_sheets(results, out)]
