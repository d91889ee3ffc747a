"""`make autorace`: lessons drive the course, or one mission of it, with many seeds."""

from __future__ import annotations

import argparse
import json
import random
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rospy
from gazebo_msgs.msg import ModelStates

from evaluation.autorace_judge import (
    BAYS,
    GROUND,
    MISSIONS,
    PLAN,
    WORLD,
    Sample,
    Score,
    off_lane,
    score,
)
from evaluation.command_line import Parser, one_of
from evaluation.picture import (
    CAR,
    FAINT,
    LINE,
    MAP_PX,
    WHITE,
    Plan,
    lap_colour,
    sheet,
    write_image,
)
from evaluation.report import cell, mean, table
from evaluation.run_page import RECORDING, begin_recording, write_run_page
from evaluation.trial import Case, Trial
from run_session import simulator
from run_session.files import world_argument
from run_session.launch import Launched
from run_session.session import Session
from trial_worlds.light import write_lit_world

ROBOT = "autorace"
START_LIMIT, SILENCE = 240.0, 60.0  # s, wall
LOOK_PERIOD = 0.3  # s, wall
STATE_HZ = 10.0
SHOWN = ("traffic_light_", "traffic_bar_")


class AutoraceStack:
    """Made once per run; successive drives use the same ROS master."""

    def __init__(self, launched: Launched):
        self._launched = launched
        launched.start_roscore()
        rospy.set_param("/use_sim_time", True)
        rospy.set_param("/gazebo/pub_state_frequency", STATE_HZ)
        rospy.init_node("autorace_trials", disable_signals=True, disable_rosout=True)
        self.samples: list[Sample] = []
        rospy.Subscriber("/gazebo/model_states", ModelStates, self._take, queue_size=1)

    def begin(self, script: str, words: list[str], log: Path) -> None:
        """Start world, mission and lesson; the simulator stays paused."""
        self.samples = []
        self._log = log
        rospy.set_param("/gazebo/state_log", str(log))
        self._recording = log.with_suffix(f".{RECORDING}")
        begin_recording(self._launched.master_uri, self._recording)
        self._child = self._launched.start(log.stem, [
            "roslaunch", "learning_autorace", "autorace.launch", f"drive:={script}", "gui:=false",
            "paused:=true", "real_time_factor:=0", "lockstep:=/cmd_vel", "lockstep_timeout:=20",
            "pub_clock_frequency:=30", *words])
        self._launched.wait_for("the robot, the mission and the lesson", self._ready, START_LIMIT,
                                pause=LOOK_PERIOD)
        simulator.unpause()

    def watch(self) -> Sample:
        """The newest sample; RunError if none comes within SILENCE."""
        time.sleep(LOOK_PERIOD)
        count = len(self.samples)
        while len(self.samples) == count:
            self._launched.check_time(self.samples[-1].time if self.samples else 0.0, SILENCE)
            time.sleep(LOOK_PERIOD)
        return self.samples[-1]

    def end(self) -> dict[str, float]:
        """End the drive; returns the touched models and the times of first contact, s."""
        self._launched.end(self._child)
        write_run_page(self._recording, self._log.with_suffix(".html"), self._log.stem)
        touched: dict[str, float] = {}
        for line in self._log.read_text(encoding="utf-8").splitlines():
            values = json.loads(line)
            for pair in values.get("contacts", []):
                for name in set(pair) - {ROBOT, *GROUND} if ROBOT in pair else ():
                    touched.setdefault(name, values["time"])
        return touched

    def _ready(self) -> bool:
        there = simulator.models()
        return (ROBOT in there and any(name.startswith(SHOWN[1]) for name in there)
                and bool(simulator.subscribers("/camera/image"))
                and bool(simulator.subscribers("/gazebo/model_states")))

    def _take(self, message: ModelStates) -> None:
        if ROBOT in message.name:
            place = message.pose[message.name.index(ROBOT)].position
            shown = frozenset(name for name in message.name if name.startswith(SHOWN))
            self.samples.append(Sample(rospy.get_time(), place.x, place.y, shown))


ALL = "all"
LOST = 0.30  # m beside the lane: the drive is over
STALLED = 40.0  # s in one place; a light or a bar takes less


@dataclass(frozen=True)
class Task:
    """The script that drives, its start pose, its time limit and its missions."""

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
class Record:
    """What happened in one drive."""

    case: Case
    light: float  # factor on the world's own light
    samples: list[Sample]
    touched: dict[str, float]  # models, with the time of first contact, s


@dataclass(frozen=True)
class DriveResult:
    """The result of one drive."""

    name: str
    mission: str
    seed: int
    light: float  # factor on the world's own light
    time: float  # s
    scores: tuple[Score, ...]
    path: list[tuple[float, float]]  # m

    @property
    def passed(self) -> bool:
        """Whether every mission passed."""
        return all(each.passed for each in self.scores)

    @property
    def line(self) -> str:
        """A one-line summary."""
        failed = [f"{each.mission} {each.why}" for each in self.scores if not each.passed]
        return (f"{self.name}: {'; '.join(failed) or 'passed'}, {self.time:.1f} s, light"
                f" x{self.light:.2f}")


class RaceTrial(Trial):
    """All drives at one ROS master."""

    program = "autorace"
    does = "Drive AutoRace 2020 by the lessons of learning_autorace, and score each mission."
    good = "every mission passed in every drive"
    writes = "report.json, report.html, autorace.png, the simulator's logs and replays"
    result, derived = DriveResult, ("passed",)

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 10, "drives", least=1)
        parser.add_whole("--first-seed", 0, "seed of the first of them")
        parser.add_argument("--mission", default=ALL, metavar="NAME",
                            help=f"one of {', '.join(TASKS)} ({ALL})")

    def check(self, options: argparse.Namespace) -> None:
        one_of("mission", "MISSION", TASKS, options.mission)

    def cases(self, options: argparse.Namespace) -> list[Case]:
        seeds = range(options.first_seed, options.first_seed + options.seeds)
        return [Case(f"{options.mission}-{seed}", options.mission, seed) for seed in seeds]

    def drive(self, session: Session, case: Case) -> Record:
        stack = session.once(lambda: AutoraceStack(session.launched("robot")))
        task, draw = TASKS[case.set], random.Random(case.seed)
        light = round(draw.uniform(0.6, 1.0), 2)
        x, y, yaw = (value + draw.uniform(-wide, wide) for value, wide in
                     zip(task.start, (0.03, 0.03, 0.08), strict=True))
        folder = session.out / "drives"
        world = write_lit_world(WORLD, WORLD.parents[1] / "models", light, folder / case.name)
        stack.begin(task.script, [
            world_argument(world), f"x_pos:={x:.4f}", f"y_pos:={y:.4f}", f"yaw:={yaw:.4f}",
            f"seed:={case.seed}"], folder / f"{case.name}.log")
        _watch(stack, task)
        touched = stack.end()
        return Record(case, light, list(stack.samples), touched)

    def judge(self, record: Record) -> DriveResult:
        case, samples = record.case, record.samples
        path = [(round(each.x, 3), round(each.y, 3)) for each in samples[::4]]
        return DriveResult(
            case.name, case.set, case.seed, record.light,
            round(samples[-1].time - samples[0].time, 1),
            tuple(score(samples, record.touched, TASKS[case.set].missions)), path)

    def table(self, results: Sequence[DriveResult]) -> str:
        rows = [("mission", "passed", "after s", "contacts", "why not")]
        for mission in MISSIONS:
            found = [each for drive in results for each in drive.scores if each.mission == mission]
            if found:
                times = [each.time for each in found if each.passed and each.time is not None]
                why = dict.fromkeys(each.why for each in found if each.why)
                rows.append((mission, f"{sum(each.passed for each in found)} of {len(found)}",
                             cell(mean(times)),
                             str(sum(len(each.contacts) for each in found)),
                             "; ".join(why) or "-"))
        return table(rows, left=(0, 4))

    def values(self, results: Sequence[DriveResult]) -> dict:
        return {"passed": self.passed(results), **super().values(results)}

    def pictures(self, results: Sequence[DriveResult], out: Path) -> list[str]:
        write_sheet(results, out / "autorace.png")
        return ["autorace.png"]


def _watch(stack: AutoraceStack, task: Task) -> None:
    """Returns when the last mission was passed, the robot is lost, or time is up."""
    stood_at = now = stack.watch()
    begin = now.time
    while now.time < begin + task.limit:
        now = stack.watch()
        if abs(now.x - stood_at.x) + abs(now.y - stood_at.y) > 0.05:
            stood_at = now
        (last,) = score(stack.samples, {}, task.missions[-1:])
        if last.passed or off_lane(now.x, now.y) > LOST or now.time - stood_at.time > STALLED:
            break


def write_sheet(drives: Sequence, path: Path) -> None:
    """Draw every drive's path; that of a failed drive ends in a cross."""
    passed = sum(each.passed for each in drives)
    plan = Plan((-2.1, -2.1), (2.1, 2.1), MAP_PX)
    plan.grid(0.5)
    for side, colour in (("left", LINE), ("right", WHITE)):
        plan.line(PLAN["lane"][side], colour, 4)
    for wall in PLAN["walls"]:
        middle, yaw = np.array(wall["middle"]), wall["yaw"]
        half = np.array((np.cos(yaw), np.sin(yaw))) * wall["length"] / 2
        plan.line((middle - half, middle + half), FAINT, 8)
    for places, colour, radius in ((PLAN["obstacles"], FAINT, 0.045), (
            PLAN["barriers"], CAR, 0.018), (BAYS.values(), WHITE, 0.025)):
        for place in places:
            plan.disc(place, radius, colour)
    for number, drive in enumerate(drives):
        plan.line(drive.path, lap_colour(number), 2)
        if not drive.passed:
            plan.cross(drive.path[-1], CAR)
    write_image(path, sheet(("AutoRace 2020", f"{passed} of {len(drives)} drives passed"), [plan],
                            [("barriers", CAR), ("bays", WHITE)]))
