"""`make avoid`: the laser's lesson drives through halls, each with its own columns and noise."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from learning_laser import hall

from evaluation.avoid import drive
from evaluation.avoid.drive import CONTACT, REACHED, Drive
from evaluation.picture import write_tiles
from evaluation.trial.command_line import Parser, one_of
from evaluation.trial.protocol import Case, ReportedTrial
from evaluation.trial.table import cell, mean, table
from run_session.resources import find_package
from run_session.session import Session

TILE = (5.0, 1.9)  # inches


@dataclass(frozen=True)
class Hall(Case):
    """The hall of a seed."""

    seed: int


class AvoidTrial(ReportedTrial):
    """Every hall is to be driven through without a contact."""

    program = "avoid"
    does = "Drive by laser through halls with columns."
    good = "all goals reached without a contact"
    writes = "report.json, report.html, paths.png and worlds"
    result = Drive

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 20, "halls", variable="SEEDS", least=1)
        parser.add_whole("--first-seed", 0, "of the first hall")
        parser.add_argument("--avoider", default="avoid_obstacles.py", metavar="FILE",
                            help="a script of learning_laser (avoid_obstacles.py)")

    def check(self, options: argparse.Namespace) -> None:
        scripts = (find_package("learning_laser") / "scripts").glob("*.py")
        self._avoider = one_of("avoider", "--avoider", sorted(each.name for each in scripts),
                               options.avoider)

    def cases(self, options: argparse.Namespace) -> list[Hall]:
        first = options.first_seed
        return [Hall(f"hall-{seed}", seed) for seed in range(first, first + options.seeds)]

    def setup(self, session: Session, case: Hall) -> None:
        folder = session.out / "halls"
        folder.mkdir(exist_ok=True)
        world, self._log = folder / f"{case.name}.world", folder / f"{case.name}.jsonl"
        world.write_text(hall.world(case.seed), encoding="utf-8")
        self._case, self._session = case, session
        self._launched = session.launched("robot", self._avoider)
        drive.bring_up(self._launched, world, case.seed, self._avoider, self._log)

    def run(self) -> list[dict]:
        try:
            return drive.watch(self._launched, self._log)
        finally:
            self._session.family.stop()

    def score(self, record: list[dict]) -> Drive:
        return drive.scored(self._case.name, self._case.seed, record)

    def table(self, results: Sequence[Drive]) -> str:
        count = Counter(each.outcome for each in results)
        times = [each.time for each in results if each.passed]
        return table([
            ("halls", "reached", "contact", "mean time, s", "slowest, s", "nearest, m"),
            (str(len(results)), str(count[REACHED]), str(count[CONTACT]), cell(mean(times)),
             f"{max(each.time for each in results):.1f}",
             f"{min(each.nearest for each in results):.2f}")])

    def pictures(self, results: Sequence[Drive], out: Path) -> list[str]:
        write_tiles(out / "paths.png", results, _draw, TILE, columns=2)
        return ["paths.png"]


def _draw(axes: object, result: Drive) -> tuple[str, bool]:
    turn = np.linspace(0, 2 * np.pi, 25)
    for x, y in hall.columns(result.seed):
        axes.fill(x + hall.RADIUS * np.cos(turn), y + hall.RADIUS * np.sin(turn), "#7a8b99")
    axes.plot(*zip(*result.path, strict=True), color="#1b6ca8")
    axes.set(xlim=(-1, hall.LENGTH - 1), ylim=(-hall.WIDTH / 2, hall.WIDTH / 2), aspect="equal")
    axes.axvline(hall.FINISH, color="#c0392b", linewidth=1)
    return f"hall {result.seed}: {result.outcome}, {result.time:.1f} s", result.passed
