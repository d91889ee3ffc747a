"""One drive from start to goal: through a yard, or past a person who crosses."""

from __future__ import annotations

import math
import time
from dataclasses import asdict, dataclass

import numpy as np

from evaluation.trial.protocol import Case
from evaluation.yards import outcomes
from evaluation.yards.judge import WALKED_INTO, Judge
from evaluation.yards.outcomes import Drive
from evaluation.yards.rig import PERSON as PERSON_MODEL
from evaluation.yards.rig import Rig
from run_session.failure import RunError
from run_session.simulator import Place
from trial_worlds import crossing
from trial_worlds.crossing import APPROACH, ROBOT_SPEED, Crossing
from trial_worlds.models import person_model, room_model, yard_model
from trial_worlds.yard import draw_yard

LOOK_PERIOD = 0.05  # s, wall
SILENCE = 30.0      # s, wall
LIMIT = 100.0       # s, simulated, as in the benchmark
NEAR = 0.2          # m from a goal that is reported reached, by the simulator's own pose
ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class YardCase(Case):
    """One drive."""

    set: str
    seed: int
    repeat: int


@dataclass(frozen=True)
class Task:
    """The task of a drive; m, rad."""

    case: YardCase
    models: dict[str, tuple[str, Place]]  # SDF and pose, by name
    start: Place
    goal: Place
    shortest: float  # length of the shortest path
    cylinders: np.ndarray  # (N, 2), centres
    drawn: dict
    walk: Crossing | None = None


def task_of(case: YardCase) -> Task:
    """The task: through a yard, or through a room that a person walks across."""
    if case.set == outcomes.YARDS:
        yard = draw_yard(case.seed)
        drawn = {"fill": yard.fill, "smoothing": yard.smoothing,
                 "path_length": yard.path_length, **asdict(yard.difficulty)}
        return Task(case, {"yard": (yard_model(yard), ORIGIN)}, yard.start(case.repeat), yard.goal,
                    yard.path_length, yard.cylinders, drawn)
    walk, start, goal = crossing.draw_crossing(case.seed), crossing.START, crossing.GOAL
    models = {"room": (room_model(), ORIGIN), PERSON_MODEL: (person_model(), walk.begin)}
    return Task(case, models, start, goal, math.dist(start[:2], goal[:2]), np.empty((0, 2)),
                asdict(walk), walk)


def prepare(rig: Rig, task: Task) -> None:
    """Set up the task's world, with the robot at its start."""
    rig.prepare(task.models, task.start)
    if task.walk is not None:
        rig.wait(rig.person_listens, "the person")


def drive(rig: Rig, task: Task, judge: Judge) -> Drive:
    """Drive from start to goal, or as far as the robot gets; the judge gets all samples."""
    ended, pace = _watch(rig, judge, task)
    straight, outcome = math.dist(task.start[:2], task.goal[:2]), _outcome(judge, ended, task.goal)
    if outcome == outcomes.NOT_THERE:
        ended = f"from {judge.off(task.goal):.2f} m away"
    return Drive(
        set=task.case.set, seed=task.case.seed, repeat=task.case.repeat, outcome=outcome,
        why=None if ended == outcomes.REACHED else ended, time=round(judge.time, 2),
        distance=round(judge.distance, 3), straight_time=round(straight / ROBOT_SPEED, 2),
        shortest_time=round(task.shortest / ROBOT_SPEED, 2),
        to_obstacles=_known(judge.to_obstacles), to_person=_known(judge.to_person),
        recoveries=list(rig.recoveries), slow_cycles=rig.slow_cycles,
        real_time_factor=round(pace, 2), drawn=task.drawn)


def _watch(rig: Rig, judge: Judge, task: Task) -> tuple[str, float]:
    """Watch until the goal has ended; returns how, and the real-time factor."""
    rig.send(task.goal)
    began, ended = time.monotonic(), None
    heard, walk, walking = began, task.walk, None  # None: the person waits
    while ended is None:
        ended = rig.result()  # before the samples, so that all of those before the end count
        for sample in rig.samples(LOOK_PERIOD):
            heard = time.monotonic()
            judge.see(sample)
            if walk and walking is None and sample.robot[0] >= walk.trigger:
                walking = True
                rig.walk(walk.speed)
            elif walking and math.dist(sample.person[:2], walk.begin[:2]) > 2 * APPROACH:
                walking = False
                rig.walk(0.0)
        if time.monotonic() > heard + SILENCE:
            raise RunError(f"no news of the robot for {SILENCE:.0f} s: the simulator hangs")
        if judge.contact or judge.time > LIMIT:
            ended = judge.contact or f"not there within {LIMIT:.0f} s"
    wall = time.monotonic() - began
    if walk:
        rig.walk(0.0)
    rig.end_goal()
    return ended, judge.time / wall


def _outcome(judge: Judge, ended: str, goal: Place) -> str:
    if judge.contact == WALKED_INTO:
        return outcomes.WALKED_INTO
    if judge.contact:
        return outcomes.CONTACT
    if ended == outcomes.REACHED:
        return outcomes.REACHED if judge.off(goal) <= NEAR else outcomes.NOT_THERE
    return outcomes.LATE if judge.time > LIMIT else outcomes.GIVEN_UP


def _known(air: float) -> float | None:
    return None if math.isinf(air) else round(air, 4)
