"""`make autorace`: the lessons drive the course, or one mission of it, with many seeds."""

from __future__ import annotations

import argparse
import random
import statistics
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from xml.etree import ElementTree

from evaluation.autorace.judge import MISSIONS, Sample, Score, off_lane, score
from evaluation.autorace.rig import Rig
from evaluation.autorace.sheet import write_sheet
from evaluation.trial.command_line import Parser, one_of
from evaluation.trial.protocol import Case, ReportedTrial
from evaluation.trial.table import cell, table
from run_session.resources import find_package
from run_session.session import Session

ALL = "all"
LOST = 0.30  # m beside the lane: the drive is over
STALLED = 40.0  # s in one place; a light or a bar lasts less


@dataclass(frozen=True)
class Task:
    """What drives, from where, and how long at most."""

    script: str
    start: tuple[float, float, float]  # x, y in m, yaw in rad
    limit: float  # s, simulated
    missions: tuple[str, ...]


TASKS = {
    "lane": Task("02lane.py", (0.78, -1.747, 0.0), 120.0, ("lane",)),
    "traffic_light": Task("03traffic_light.py", (0.70, -1.747, 0.0), 40.0, ("traffic_light",)),
    "parking": Task("06parking.py", (1.05, 1.747, 3.1416), 80.0, ("parking",)),
    "bar": Task("04bar.py", (-1.1, 1.25, 3.1416), 60.0, ("bar",)),
    "tunnel": Task("05tunnel.py", (-1.72, 0.4, -1.5708), 80.0, ("tunnel",)),
    ALL: Task("07course.py", (0.78, -1.747, 0.0), 300.0, MISSIONS),
}


@dataclass(frozen=True)
class RaceCase(Case):
    """One drive."""

    mission: str
    seed: int


@dataclass(frozen=True)
class Drive:
    """What became of it."""

    name: str
    mission: str
    seed: int
    light: float  # times the world's own
    time: float  # s
    scores: tuple[Score, ...]
    path: list[tuple[float, float]]  # m

    @property
    def passed(self) -> bool:
        """Every mission of it."""
        return all(each.passed for each in self.scores)


class RaceTrial(ReportedTrial):
    """All drives at one ROS master."""

    program = "autorace"
    does = "Drive AutoRace 2020 by the lessons of learning_autorace, and score each mission."
    good = "every mission passed in every drive"
    writes = "report.json, report.html, autorace.png and the simulator's logs"

    def __init__(self) -> None:
        self._rig: Rig | None = None

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 10, "drives", variable="SEEDS", least=1)
        parser.add_whole("--first-seed", 0, "seed of the first of them")
        parser.add_argument("--mission", default=ALL, metavar="NAME",
                            help=f"one of {', '.join(TASKS)} ({ALL})")

    def check(self, options: argparse.Namespace) -> None:
        one_of("mission", "MISSION", TASKS, options.mission)

    def cases(self, options: argparse.Namespace) -> list[RaceCase]:
        seeds = range(options.first_seed, options.first_seed + options.seeds)
        return [RaceCase(f"{options.mission}-{seed}", options.mission, seed) for seed in seeds]

    def setup(self, session: Session, case: RaceCase) -> None:
        if self._rig is None:
            self._rig = Rig(session.launched("robot"))
        self._case, self._task = case, TASKS[case.mission]
        draw = random.Random(case.seed)
        self._light = round(draw.uniform(0.6, 1.0), 2)
        x, y, yaw = (value + draw.uniform(-wide, wide) for value, wide in
                     zip(self._task.start, (0.03, 0.03, 0.08), strict=True))
        folder = session.out / "drives"
        folder.mkdir(exist_ok=True)
        world = folder / f"{case.name}.world"
        write_dimmed(find_package("turtlebot3_gazebo") / "worlds/turtlebot3_autorace_2020.world",
                     self._light, world)
        self._rig.begin(self._task.script, [
            f"world_name:={world}", f"x_pos:={x:.4f}", f"y_pos:={y:.4f}", f"yaw:={yaw:.4f}",
            f"seed:={case.seed}"], folder / f"{case.name}.log")

    def run(self) -> tuple[list[Sample], dict[str, float]]:
        """Where the robot was, and what it touched."""
        stood_at = now = self._rig.watch()
        begin = now.time
        while now.time < begin + self._task.limit:
            now = self._rig.watch()
            if abs(now.x - stood_at.x) + abs(now.y - stood_at.y) > 0.05:
                stood_at = now
            (last,) = score(self._rig.samples, {}, self._task.missions[-1:])
            if (last.passed or off_lane(now.x, now.y) > LOST
                    or now.time - stood_at.time > STALLED):
                break
        touched = self._rig.end()
        return list(self._rig.samples), touched

    def score(self, record: tuple[list[Sample], dict[str, float]]) -> Drive:
        samples, touched = record
        path = [(round(each.x, 3), round(each.y, 3)) for each in samples[::4]]
        return Drive(self._case.name, self._case.mission, self._case.seed, self._light,
                     round(samples[-1].time - samples[0].time, 1),
                     tuple(score(samples, touched, self._task.missions)), path)

    def passed(self, results: Sequence[Drive]) -> bool:
        return all(each.passed for each in results)

    def line(self, result: Drive) -> str:
        failed = [f"{each.mission} {each.why}" for each in result.scores if not each.passed]
        return (f"{result.name}: {'; '.join(failed) or 'passed'}, {result.time:.1f} s, light"
                f" x{result.light:.2f}")

    def table(self, results: Sequence[Drive]) -> str:
        rows = [("mission", "passed", "after s", "contacts", "why not")]
        for mission in MISSIONS:
            found = [each for drive in results for each in drive.scores if each.mission == mission]
            if found:
                times = [each.time for each in found if each.passed and each.time is not None]
                why = dict.fromkeys(each.why for each in found if each.why)
                rows.append((mission, f"{sum(each.passed for each in found)} of {len(found)}",
                             cell(statistics.fmean(times) if times else None),
                             str(sum(len(each.contacts) for each in found)),
                             "; ".join(why) or "-"))
        return table(rows, left=(0, 4))

    def values(self, results: Sequence[Drive]) -> dict:
        return {"passed": self.passed(results),
                "drives": [{**asdict(each), "passed": each.passed} for each in results]}

    def from_values(self, values: dict) -> list[Drive]:
        drives = []
        for each in values["drives"]:
            kept = {name: each[name] for name in Drive.__dataclass_fields__}
            kept["scores"] = tuple(Score(**one) for one in each["scores"])
            drives.append(Drive(**kept))
        return drives

    def pictures(self, results: Sequence[Drive], out: Path) -> list[str]:
        write_sheet(results, out / "autorace.png")
        return ["autorace.png"]


def write_dimmed(world: Path, factor: float, path: Path) -> None:
    """Write a copy of a world file whose lights are that much weaker."""
    tree = ElementTree.parse(world)
    for diffuse in tree.iterfind("world/light/diffuse"):
        *rgb, opacity = map(float, diffuse.text.split())
        diffuse.text = " ".join(f"{value:.4g}" for value in (*(factor * c for c in rgb), opacity))
    tree.write(path, encoding="unicode", xml_declaration=True)
