"""Our full physics step beside PyBullet's bare one, in the same world and on the same client.

The course with its waffle, standing still and driving a circle. Blocks of bare `stepSimulation` and
of `World.step` take turns; wheel motors keep their last command, so that the engine has the
same to do in both. A world in which nothing moves for a while leaves the engine out: a force of
nothing before each block keeps the standing waffle's world awake, and a ratio that only a step
without the engine could have is an error.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from functools import partial

from bullet_sim.model import Model
from bullet_sim.physics.engine import pybullet
from run_session.failure import RunError
from sim_bench.course import CourseWorld, drive_of
from sim_bench.figures import Figure, figure, ratio
from sim_bench.settings import Settings

RUNS = 11
BLOCK, BLOCKS = 200, 5  # steps between two nudges (too few to fall asleep); blocks of a run
STEP = 0.001  # s, of the course's world
SPEED, YAW_RATE = 0.15, 0.3  # m/s, rad/s: a circle of 0.5 m radius
DRIVE_PERIOD, DRIVE_STEPS = 1 / 30, 33  # s and steps between updates of the waffle's drive
MOST_CLIENTS = 64
LEAST_RATIO = 0.8  # of a step that holds a bare one; below that it cannot have


def measure(settings: Settings) -> list[Figure]:
    """Microseconds a step of either kind, and how many times the bare one ours takes."""
    course, bare = open_course()
    waffle = course.spawn_waffle()
    found = _compare("standing", course, waffle, bare, settings)
    _drive_a_circle(course, waffle)
    found += _compare("driving", course, waffle, bare, settings)
    course.close()
    return found


def bare_step_time() -> float:
    """Seconds of one bare step with the waffle driving, for parts that compare with it."""
    course, bare = open_course()
    _drive_a_circle(course, course.spawn_waffle())
    seconds = _timed(bare, BLOCK * BLOCKS)
    course.close()
    return seconds


def check_same_work(state: str, median: float) -> None:
    """RunError for a ratio that shows that our step has not run the engine."""
    if median < LEAST_RATIO:
        raise RunError(
            f"{state}: World.step takes {median:.2f} of the bare step that it should hold:"
            " it leaves the engine out, and cannot be compared"
        )


def open_course() -> tuple[CourseWorld, Callable[[], None]]:
    """The course, and the bare step of the same client."""
    before = _clients()
    course = CourseWorld()
    (client,) = _clients() - before
    return course, partial(pybullet.stepSimulation, physicsClientId=client)


def _drive_a_circle(course: CourseWorld, waffle: Model) -> None:
    drive = drive_of(waffle, SPEED, YAW_RATE)
    for _ in range(60):  # until its speed is reached
        drive.update(DRIVE_PERIOD)
        course.world.step(DRIVE_STEPS)


def _compare(state: str, course: CourseWorld, waffle: Model, bare: Callable[[], None],
             settings: Settings) -> list[Figure]:
    kinds = {"bare": bare, "ours": course.world.step}
    runs = []
    for _ in range(settings.runs(RUNS)):
        blocks = [[_timed_awake(waffle, step) for step in kinds.values()] for _ in range(BLOCKS)]
        runs.append([1e6 * statistics.median(block) for block in zip(*blocks)])
    times = dict(zip(kinds, zip(*runs)))
    found = [figure(f"step.{kind}.{state}", "us", values) for kind, values in times.items()]
    compared = ratio(f"ratio.{state}", times["ours"], times["bare"])
    check_same_work(state, compared.median)
    return [*found, compared]


def _timed_awake(waffle: Model, step: Callable[[], None]) -> float:
    """Seconds of a step. Whatever is done to a body from outside ends a world's rest; no force
    moves nothing."""
    next(iter(waffle.links.values())).apply_force((0.0, 0.0, 0.0))
    return _timed(step, BLOCK)


def _timed(step: Callable[[], None], steps: int) -> float:
    """Seconds of one step, by the mean of `steps`."""
    start = time.perf_counter()
    for _ in range(steps):
        step()
    return (time.perf_counter() - start) / steps


def _clients() -> set[int]:
    """PyBullet's numbers of the worlds that are open in this process."""
    return {number for number in range(MOST_CLIENTS) if pybullet.isConnected(number)}
