"""`make avoid`: the laser lesson drives through halls, judged by the simulator's own log."""

from __future__ import annotations

import argparse
import json
import math
import xmlrpc.client
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import rosgraph
from learning_laser import hall

from evaluation.command_line import Parser, one_of
from evaluation.picture import CAR, FAINT, Plan, lap_colour, write_tiles
from evaluation.report import cell, mean, table
from evaluation.run_log import RUN_LOG, begin_run_log, marks_in
from evaluation.run_page import RECORDING, begin_recording, write_run_page
from evaluation.trial import Case, Trial
from run_session.failure import RunError
from run_session.files import Tail, find_package, world_argument
from run_session.launch import Launched
from run_session.master import look_up
from run_session.session import Session
from run_session.simulator import WAFFLE, models, unpause

START_LIMIT = 120.0  # s, wall
LIMIT = 120.0  # s, simulated
TOPICS = ("/scan", "/cmd_vel")
REACHED, CONTACT, LATE = "reached", "contact", "late"
TILE_PX = 500


@dataclass(frozen=True)
class DriveResult:
    """The result of one drive; m, s."""

    name: str
    seed: int
    outcome: str
    time: float
    distance: float  # driven
    nearest: float  # from the axle's middle to a column's or wall's surface
    unanswered: int  # scans
    path: list[list[float]] = field(repr=False)  # x, y

    @property
    def passed(self) -> bool:
        """Whether it arrived without a contact."""
        return self.outcome == REACHED

    @property
    def line(self) -> str:
        """A one-line summary."""
        return (f"{self.name}: {self.outcome} after {self.time:.1f} s and {self.distance:.1f} m,"
                f" nearest {self.nearest:.2f} m")


class AvoidTrial(Trial):
    """Every hall must be driven through without a contact."""

    program = "avoid"
    does = "Drive by laser through halls with columns."
    good = "all goals reached without a contact"
    writes = "report.json, report.html, paths.png, worlds and a replay of each"
    result, shared = DriveResult, ("avoider",)

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 20, "halls", least=1)
        parser.add_whole("--first-seed", 0, "of the first hall")
        parser.add_argument("--avoider", default="avoid_obstacles.py", metavar="FILE",
                            help="a script of learning_laser (avoid_obstacles.py)")

    def check(self, options: argparse.Namespace) -> None:
        scripts = (find_package("learning_laser") / "scripts").glob("*.py")
        one_of("avoider", "--avoider", sorted(each.name for each in scripts), options.avoider)

    def cases(self, options: argparse.Namespace) -> list[Case]:
        first = options.first_seed
        return [Case(f"hall-{seed}", seed=seed) for seed in range(first, first + options.seeds)]

    def drive(self, session: Session, case: Case) -> tuple[Case, list[dict]]:
        """The case, and the simulator's states up to the drive's end."""
        folder = session.out / "halls"
        folder.mkdir(exist_ok=True)
        world, log = folder / f"{case.name}.world", folder / f"{case.name}.jsonl"
        world.write_text(hall.world(case.seed), encoding="utf-8")
        launched = session.launched("robot", self.options.avoider)
        bring_up(launched, world, case.seed, self.options.avoider, log)
        try:
            states = watch(launched, log)
        finally:
            session.family.stop()
        write_run_page(world.with_suffix(f".{RECORDING}"), world.with_suffix(".html"), case.name,
                       marks=marks_in(world.with_suffix(f".{RUN_LOG}")))
        return case, states

    def judge(self, record: tuple[Case, list[dict]]) -> DriveResult:
        case, states = record
        return scored(case.name, case.seed, states)

    def table(self, results: Sequence[DriveResult]) -> str:
        count = Counter(each.outcome for each in results)
        times = [each.time for each in results if each.passed]
        return table([
            ("halls", "reached", "contact", "mean time, s", "slowest, s", "nearest, m"),
            (str(len(results)), str(count[REACHED]), str(count[CONTACT]), cell(mean(times)),
             f"{max(each.time for each in results):.1f}",
             f"{min(each.nearest for each in results):.2f}")])

    def pictures(self, results: Sequence[DriveResult], out: Path) -> list[str]:
        write_tiles(out / "paths.png", list(map(_tile, results)), columns=2)
        return ["paths.png"]


def bring_up(launched: Launched, world: Path, seed: int, avoider: str, state_log: Path) -> None:
    """Start all, wait until all nodes are connected, and unpause."""
    launched.start_roscore()
    begin_recording(launched.master_uri, world.with_suffix(f".{RECORDING}"))
    words = ("evaluation", "avoid.launch", world_argument(world), f"seed:={seed}",
             f"avoider:={avoider}", f"state_log:={state_log}", "paused:=true",
             "real_time_factor:=0")
    begin_run_log(launched.master_uri, world.with_suffix(f".{RUN_LOG}"), words, avoider, *TOPICS)
    launched.start("roslaunch", ["roslaunch", *words])
    launched.wait_for(f"model {WAFFLE}", lambda: WAFFLE in models(), START_LIMIT)
    launched.wait_for(f"who reads /scan ({avoider})", lambda: _connected(launched.master_uri),
                      START_LIMIT)
    unpause()


def watch(launched: Launched, state_log: Path) -> list[dict]:
    """The log's states up to the finish, the first contact or LIMIT."""
    states: list[dict] = []
    log = Tail(state_log)
    while not (states and outcome(states[-1])):
        launched.wait_for("the next state", lambda: _take(states, log.lines()), START_LIMIT)
    return states


def outcome(state: dict) -> str | None:
    """How the drive has ended by this state; None: it goes on."""
    if any({WAFFLE, "hall"} == set(pair) for pair in state["contacts"]):
        return CONTACT
    if state["poses"][WAFFLE][0] > hall.FINISH:
        return REACHED
    return LATE if state["time"] > LIMIT else None


def scored(name: str, seed: int, states: list[dict]) -> DriveResult:
    """The result computed from a drive's states."""
    path = np.array([state["poses"][WAFFLE][:2] for state in states])
    away = np.hypot(*(path[:, None] - hall.columns(seed)).transpose(2, 0, 1)) - hall.RADIUS
    nearest = min(away.min(), hall.WIDTH / 2 - np.abs(path[:, 1]).max())
    distance = float(np.hypot(*np.diff(path, axis=0).T).sum())
    return DriveResult(
        name, seed, outcome(states[-1]), round(states[-1]["time"], 2), round(distance, 3),
        round(float(nearest), 3), states[-1]["unanswered"], path.round(4).tolist())


def _connected(master_uri: str) -> bool:
    try:
        found = look_up(master_uri, "/avoid", TOPICS)
    except (OSError, xmlrpc.client.Error, rosgraph.MasterException):
        return False
    return all(found.publishers[topic] and found.subscribers[topic]
               and not found.missing_link(topic) for topic in TOPICS)


def _take(states: list[dict], lines: Sequence[str]) -> bool:
    """Add the robot's states up to the drive's end; True if there were any. RunError: bad log."""
    try:
        found = [state for state in map(json.loads, lines)
                 if WAFFLE in state.get("poses", {}) and math.isfinite(state["time"])]
    except ValueError as error:
        raise RunError(f"the simulator's log of states: {error}") from error
    end = next((number for number, state in enumerate(found, 1) if outcome(state)), len(found))
    states += found[:end]
    return bool(found)


def _tile(result: DriveResult) -> tuple[str, bool, np.ndarray]:
    plan = Plan((-1, -hall.WIDTH / 2), (hall.LENGTH - 1, hall.WIDTH / 2), TILE_PX)
    for place in hall.columns(result.seed):
        plan.disc(place, hall.RADIUS, FAINT)
    plan.line([(hall.FINISH, -hall.WIDTH), (hall.FINISH, hall.WIDTH)], CAR)
    plan.line(result.path, lap_colour(0), 2)
    return (f"hall {result.seed}: {result.outcome}, {result.time:.1f} s", result.passed,
            plan.image)
