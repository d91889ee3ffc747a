"""`make navigation-trials`: move_base without a map through narrow yards and past people."""

from __future__ import annotations

import argparse
import json
import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from evaluation import yard_drive
from evaluation.command_line import Parser
from evaluation.picture import CAR, FAINT, GOOD, Plan, chart, lap_colour, write_tiles
from evaluation.report import cell, grouped, mean, table_of
from evaluation.trial import Case, Trial
from evaluation.yard_drive import CROSSINGS, YARDS, NavigationStack, Record
from run_session.failure import RunError
from run_session.files import find_package
from run_session.session import Session
from trial_worlds import crossing
from trial_worlds.yard import APRON, CELL, RADIUS, SIZE, draw_yard, places

REACHED, TOUCHED, WALKED_INTO, GIVEN_UP, LATE, NOT_THERE = (
    "reached", "contact", "walked into", "given up", "late", "called reached")
NEAR = 0.2  # m from a goal that is reported reached, by the simulator's own pose
LEAST_SHARE = 0.95  # of the yards, and of the crossings except those that people ended
BEST, WORST = 4.0, 8.0  # multiples of the shortest time between which BARN's score falls


@dataclass(frozen=True)
class DriveResult:
    """The result of one drive; m, s."""

    set: str
    seed: int
    repeat: int
    outcome: str
    why: str | None
    time: float
    distance: float
    straight_time: float  # of the straight line from start to goal at top speed
    shortest_time: float  # of the shortest path that is wide enough, at top speed
    to_obstacles: float | None  # the least gap; None: there were none
    to_person: float | None
    recoveries: list[str]
    slow_cycles: int  # move_base's warnings that it was too slow, at most one in 5 s
    real_time_factor: float
    drawn: dict = field(default_factory=dict)  # the yard's difficulty, or the person's walk

    @property
    def reached(self) -> bool:
        """Whether it reached its goal without touching anything."""
        return self.outcome == REACHED

    @property
    def score(self) -> float:
        """The BARN challenge's: 0.25 for a fast drive, 0.125 for a slow one, 0 for none."""
        if not self.reached:
            return 0.0
        return self.shortest_time / min(max(self.time, BEST * self.shortest_time),
                                        WORST * self.shortest_time)

    @property
    def name(self) -> str:
        """Its case's name, also that of its files."""
        return f"{self.set}-{self.seed}-{self.repeat}"

    @property
    def line(self) -> str:
        """A one-line summary."""
        why = f" ({self.why})" if self.why else ""
        air = self.to_obstacles if self.to_person is None else self.to_person
        recovered = f", {len(self.recoveries)} recoveries" if self.recoveries else ""
        return (f"{self.name}: {self.outcome}{why}, {self.time:.1f} s (straight"
                f" {self.straight_time:.1f} s), {cell(air, 100, 1)} cm of air{recovered},"
                f" real time x{self.real_time_factor:.2f}")


def judged(record: Record) -> DriveResult:
    """Judge one drive."""
    task, passage, case = record.task, record.passage, record.task.case
    outcome, why = _outcome(record)
    return DriveResult(
        set=case.set, seed=case.seed, repeat=case.repeat, outcome=outcome, why=why,
        time=round(passage.time, 2), distance=round(passage.distance, 3),
        straight_time=round(math.dist(task.start[:2], task.goal[:2]) / crossing.ROBOT_SPEED, 2),
        shortest_time=round(task.shortest / crossing.ROBOT_SPEED, 2),
        to_obstacles=_known(passage.to_obstacles), to_person=_known(passage.to_person),
        recoveries=record.recoveries, slow_cycles=record.slow_cycles,
        real_time_factor=round(record.real_time_factor, 2), drawn=task.drawn)


def _outcome(record: Record) -> tuple[str, str | None]:
    """How a drive ended, in one word and in others."""
    passage, ended, off = record.passage, record.ended, record.passage.off(record.task.goal)
    if passage.contact:
        return (WALKED_INTO if passage.contact == yard_drive.BY_PERSON else TOUCHED), ended
    if ended == REACHED:
        return (REACHED, None) if off <= NEAR else (NOT_THERE, f"from {off:.2f} m away")
    return (LATE if passage.time > yard_drive.LIMIT else GIVEN_UP), ended


def _known(air: float) -> float | None:
    return None if math.isinf(air) else round(air, 4)


COLUMNS = {
    "drives": lambda each: each["set"],
    "reached": lambda each: f"{each['outcomes'].get(REACHED, 0)} of {each['drives']}",
    "": lambda each: f"{each['share_reached']:.0%}",
    "s": lambda each: cell(each["mean_time"]),
    "straight s": lambda each: cell(each["mean_straight_time"]),
    "ratio": lambda each: cell(each["mean_time_by_straight"], 1, 2),
    "BARN": lambda each: cell(each["mean_score"], 1, 3),
    "air cm": lambda each: cell(each["least_to_obstacles"], 100),
    "to person cm": lambda each: cell(each["least_to_person"], 100),
    "with recovery": lambda each: str(each["drives_with_recovery"])}


def summarize(drives: Sequence[DriveResult]) -> list[dict]:
    """A summary for each set; means are of drives that reached the goal, None if none did."""
    return [_summary(*group) for group in grouped(drives, lambda drive: drive.set).items()]


def _summary(name: str, drives: list[DriveResult]) -> dict:
    there = [drive for drive in drives if drive.reached]
    return {
        "set": name, "drives": len(drives),
        "outcomes": dict(Counter(sorted(drive.outcome for drive in drives))),
        "share_reached": len(there) / len(drives),
        "mean_time": mean([drive.time for drive in there]),
        "mean_straight_time": mean([drive.straight_time for drive in there]),
        "mean_time_by_straight": mean([drive.time / drive.straight_time for drive in there]),
        "mean_time_by_shortest": mean([drive.time / drive.shortest_time for drive in there]),
        "mean_score": mean([drive.score for drive in drives]),
        "least_to_obstacles": min(
            (d.to_obstacles for d in there if d.to_obstacles is not None), default=None),
        "least_to_person": min(
            (d.to_person for d in there if d.to_person is not None), default=None),
        "drives_with_recovery": sum(bool(drive.recoveries) for drive in drives),
        "failed": [drive.name for drive in drives if not drive.reached]}


HALF = SIZE * CELL / 2  # m
YARD = (-APRON * CELL, -HALF), ((SIZE + APRON) * CELL, HALF)  # m, its corners
ROOM = (-0.2, -HALF), (5.2, HALF)
TILE_PX = 340
COLOURS = {REACHED: "#1b6ca8", NOT_THERE: "#16a085", TOUCHED: "#c0392b",
           WALKED_INTO: "#8e44ad", GIVEN_UP: "#c9782f", LATE: "#7a8b99"}

# Set, labels of x and y axis, and their values.
Figure = Callable[[DriveResult], float]
PANELS: tuple[tuple[str, str, str, Figure, Figure], ...] = (
    (YARDS, "yard", "time by straight-line time",
     lambda drive: drive.seed, lambda drive: drive.time / drive.straight_time),
    (YARDS, "closest obstacle along the shortest way, cells", "time by straight-line time",
     lambda drive: drive.drawn["closest_obstacle"],
     lambda drive: drive.time / drive.straight_time),
    (YARDS, "yard", "least air, cm",
     lambda drive: drive.seed, lambda drive: (drive.to_obstacles or 0.0) * 100),
    (CROSSINGS, "crossing", "least air to the person, cm",
     lambda drive: drive.seed, lambda drive: (drive.to_person or 0.0) * 100))


def write_chart(drives: Sequence[DriveResult], path: Path) -> None:
    """Four panels; the colour says how a drive ended."""
    with chart(path, 2, 2) as grid:
        for axes, (kind, along, across, x, y) in zip(grid.flat, PANELS, strict=True):
            _draw(axes, [drive for drive in drives if drive.set == kind], x, y)
            axes.set_xlabel(along, fontsize=9)
            axes.set_ylabel(across, fontsize=9)


def _draw(axes: object, drives: Sequence[DriveResult], x: Figure, y: Figure) -> None:
    for outcome, colour in COLOURS.items():
        found = [drive for drive in drives if drive.outcome == outcome]
        if found:
            marker = "o" if outcome == REACHED else "x"
            axes.plot([x(drive) for drive in found], [y(drive) for drive in found], marker,
                      color=colour, label=f"{outcome}: {len(found)}")
    if drives:
        axes.legend(fontsize=8)
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))


def write_sheets(drives: Sequence[DriveResult], out: Path) -> list[str]:
    """Write yards.png and crossings.png below `out`; returns their names."""
    written = []
    sets = grouped(drives, lambda drive: drive.set)
    for kind, edges, ground in ((YARDS, YARD, _draw_yard), (CROSSINGS, ROOM, _draw_walk)):
        if kind in sets:
            tiles = []
            for group in grouped(sets[kind], lambda drive: drive.seed).values():
                plan = Plan(*edges, TILE_PX)
                ground(plan, group[0])
                tiles.append((*_draw_ways(plan, group, out), plan.image))
            write_tiles(out / f"{kind}.png", tiles)
            written.append(f"{kind}.png")
    return written


def _draw_yard(plan: Plan, drive: DriveResult) -> None:
    """Draw the columns and the shortest path."""
    yard = draw_yard(drive.seed)
    for place in yard.cylinders:
        plan.disc(place, RADIUS, FAINT)
    plan.line(places(yard.path), GOOD, 3)


def _draw_walk(plan: Plan, drive: DriveResult) -> None:
    """Draw the strip that the person walks through."""
    walk = crossing.Crossing(**drive.drawn)
    begin, yaw = np.array(walk.begin[:2]), walk.heading
    end = begin + 2 * crossing.APPROACH * np.array([np.cos(yaw), np.sin(yaw)])
    plan.line([begin, end], lap_colour(3), round(2 * crossing.PERSON_RADIUS * plan.px_per_m))


def _draw_ways(plan: Plan, drives: list[DriveResult], out: Path) -> tuple[str, bool]:
    """Draw the paths, with a dot where one missed its goal; returns the caption and success."""
    for drive in drives:
        path = out / "drives" / f"{drive.name}.json"
        if path.exists():
            way = np.array(json.loads(path.read_text()))[:, 1:3]
            plan.line(way, lap_colour(drive.repeat))
            if not drive.reached:
                plan.dots(way[-1:], CAR)
    said = ", ".join(f"{each.time:.0f} s" if each.reached else each.outcome for each in drives)
    return f"{drives[0].seed}: {said}", all(each.reached for each in drives)


PARAMETERS = Path("config") / "yard.yaml"


class YardTrial(Trial):
    """All drives run in one simulator, which is started for the first of them."""

    program = "navigation_trials"
    does = ("Drive the waffle by move_base, without a map, through narrow yards and past persons"
            " who cross its way.")
    good = "at least 95 %% of the yards crossed and no person touched"
    writes = "report.json, report.html, pictures, worlds and drives"
    result, derived, shared = DriveResult, ("score",), ("parameters",)

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

    def cases(self, options: argparse.Namespace) -> list[Case]:
        yards = range(options.first_yard, options.first_yard + options.yards)
        crossings = range(options.first_crossing, options.first_crossing + options.crossings)
        trials = [(YARDS, seed, repeat) for repeat in range(options.repeats) for seed in yards]
        trials += [(CROSSINGS, seed, 0) for seed in crossings]
        return [Case("-".join(map(str, each)), *each[:2], repeat=each[2]) for each in trials]

    def drive(self, session: Session, case: Case) -> Record:
        """What happened; the path is written below drives/."""
        options, task = self.options, yard_drive.task_of(case)
        stack = session.once(lambda: NavigationStack(
            session.launched("robot"), options.real_time_factor, options.parameters))
        if case.set == YARDS:
            path = session.out / "worlds" / f"yard_{case.seed}.world"
            path.parent.mkdir(exist_ok=True)
            path.write_text(crossing.world(task.models["yard"][0]), encoding="utf-8")
        record = yard_drive.drive_task(stack, task)
        path = session.out / "drives" / f"{case.name}.json"
        path.parent.mkdir(exist_ok=True)
        rounded = [[round(value, 4) for value in place] for place in record.passage.path]
        path.write_text(json.dumps(rounded) + "\n", encoding="utf-8")
        return record

    def judge(self, record: Record) -> DriveResult:
        return judged(record)

    def passed(self, results: Sequence[DriveResult]) -> bool:
        """Whether enough goals were reached, and the robot, while moving, touched nobody."""
        touched = any(d.set == CROSSINGS and d.outcome == TOUCHED for d in results)
        sets = grouped((d for d in results if d.outcome != WALKED_INTO), lambda d: d.set)
        shares = [sum(d.reached for d in found) / len(found) for found in sets.values()]
        return not touched and min(shares, default=1.0) >= LEAST_SHARE

    def table(self, results: Sequence[DriveResult]) -> str:
        return table_of(COLUMNS, summarize(results), left=())

    def values(self, results: Sequence[DriveResult]) -> dict:
        return {
            "least_share_of_yards": LEAST_SHARE,
            "passed": self.passed(results),
            "summaries": summarize(results),
            **super().values(results),
        }

    def pictures(self, results: Sequence[DriveResult], out: Path) -> list[str]:
        write_chart(results, out / "trials.png")
        return ["trials.png", *write_sheets(results, out)]
