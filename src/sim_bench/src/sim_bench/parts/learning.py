"""The learning environment beside what gym-line-follower does with PyBullet's two renderers.

Ours is all of LineFollow-v0's step with `timestep=0.004` (`coarse`): the wheels, 8 or 9 steps of
the engine, the picture, the score. Theirs is the part of such a step that PyBullet
does, of the same scene: ten engine steps of 4 ms, getCameraImage as gym-line-follower calls it,
and the picture as an array; no score. In two processes both count at once.
"""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from run_session.failure import RunError
from sim_bench.course import CourseWorld, drive_of
from sim_bench.drawing import PLUGIN, SAYS, TINY, PybulletDrawing
from sim_bench.figures import Figure, figure, ratio
from sim_bench.own_process import Contest
from sim_bench.settings import Settings, say

SIZES = ((84, 84), (320, 240))  # px
COARSE = "coarse"
RUNS, SECONDS = 5, 2.0  # turns; s of each
SUB_STEPS, SUB_STEP = 10, 0.004  # of gym-line-follower, s
SPEED, TURN = 0.15, 0.1  # m/s, rad/s


def measure(settings: Settings) -> list[Figure]:
    """Environment steps a second, and how many times theirs ours are; RunError if it is absent."""
    if importlib.util.find_spec("gymnasium") is None:
        raise RunError("no module gymnasium: scripts/setup.sh --learning")
    found = []
    for count in (1, 2):
        with Contest({COARSE: COARSE, TINY: SAYS[TINY], PLUGIN: SAYS[PLUGIN]}, count) as contest:
            for size in SIZES:
                say(f"environment steps at {size[0]}x{size[1]}, {count} at once")
                found += _compare(contest, size, f"{size[0]}x{size[1]}.{count}", settings)
    return found


def _compare(contest: Contest, size: tuple[int, int], name: str,
             settings: Settings) -> list[Figure]:
    turns = [contest.turn(_rate, size, settings.seconds(SECONDS))
             for _ in range(settings.runs(RUNS) + 1)][1:]  # the first is for opening things
    rates = {kind: [sum(turn[kind]) for turn in turns] for kind in turns[-1]}
    found = [figure(f"steps.{kind}.{name}", "1/s", values) for kind, values in rates.items()]
    return found + [ratio(f"ratio.{COARSE}.{kind}.{name}", rates[COARSE], values)
                    for kind, values in rates.items() if kind != COARSE]


def _rate(kind: str, size: tuple[int, int], seconds: float) -> float:
    """In a process of its own: steps a second over that time."""
    step = _open(kind, size)
    count, began = 0, time.perf_counter()
    while time.perf_counter() - began < seconds:
        step()
        count += 1
    return count / (time.perf_counter() - began)


@lru_cache
def _open(kind: str, size: tuple[int, int]) -> Callable[[], object]:
    return _our_step(size) if kind == COARSE else _their_step(kind, size)


def _our_step(size: tuple[int, int]) -> Callable[[], object]:
    import gymnasium

    import driving_courses  # noqa: F401  (names the environments)

    env = gymnasium.make("driving_courses/LineFollow-v0", size=size, timestep=SUB_STEP)
    env.reset(seed=0)
    action = np.array([SPEED, TURN], np.float32)

    def step() -> None:
        _, _, over, late, _ = env.step(action)
        if over or late:
            env.reset()

    return step


def _their_step(kind: str, size: tuple[int, int]) -> Callable[[], object]:
    course = CourseWorld(SUB_STEP)
    waffle = course.spawn_waffle()
    drive = drive_of(waffle, SPEED, TURN)
    drawing = PybulletDrawing(course.world.update_scene(), plugin=kind == PLUGIN, fastest=False)

    def step() -> np.ndarray:
        drive.update(SUB_STEPS * SUB_STEP)
        course.world.step(SUB_STEPS)
        course.world.update_scene()
        drawing.place()
        return np.array(drawing.draw(course.view(waffle, *size)))[:, :, :3]

    return step
