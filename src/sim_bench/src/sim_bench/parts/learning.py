"""The learning environment beside what gym-line-follower does with PyBullet's two renderers.

Ours is all of LineFollow-v0's step with `timestep=0.004` (`coarse`): the wheels, 8 or 9 steps of
the engine, the picture, the score. Theirs is the part of such a step that PyBullet
does, of the same scene: ten engine steps of 4 ms, getCameraImage as gym-line-follower calls it,
and the picture as an array; no score. In two processes both count at once.
"""

from __future__ import annotations

import importlib.util
import multiprocessing
import os
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from functools import lru_cache

import numpy as np

from bullet_sim.physics.engine import STDOUT
from bullet_sim.world import World
from run_session.failure import RunError
from sim_bench.course import CourseWorld, drive_of
from sim_bench.drawing_process import PLUGIN, TINY
from sim_bench.figures import Figure, figure, ratio
from sim_bench.pybullet_drawing import PybulletDrawing
from sim_bench.settings import Settings

SIZES = ((84, 84), (320, 240))  # px
COARSE = "coarse"
RUNS, SECONDS = 5, 2.0  # turns; s of each
SUB_STEPS, SUB_STEP = 10, 0.004  # of gym-line-follower, s
SPEED, TURN = 0.15, 0.1  # m/s, rad/s
LIMIT = 120.0  # s, wall, for one answer
NEEDED = ("gymnasium", "driving_courses")


def measure(settings: Settings) -> list[Figure]:
    """Environment steps a second, and how many times theirs ours are; RunError if it is absent."""
    for module in NEEDED:
        if importlib.util.find_spec(module) is None:
            raise RunError(f"no module {module}: scripts/setup.sh --learning")
    found = []
    for processes in (1, 2):
        pools = {kind: ProcessPoolExecutor(processes, multiprocessing.get_context("spawn"))
                 for kind in (COARSE, TINY, PLUGIN)}
        try:
            for size in SIZES:
                settings.say(f"environment steps at {size[0]}x{size[1]}, {processes} at once")
                found += _rates(pools, size, processes, settings)
        finally:
            for pool in pools.values():
                pool.shutdown(cancel_futures=True)
    return found


def _rates(pools: dict[str, ProcessPoolExecutor], size: tuple[int, int], processes: int,
           settings: Settings) -> list[Figure]:
    """Contenders take turns; one that cannot is left out, with a line."""
    rates: dict[str, list[float]] = {kind: [] for kind in pools}
    for run in range(settings.runs(RUNS) + 1):
        for kind in list(rates):
            asked = [pools[kind].submit(_rate, kind, size, settings.seconds(SECONDS))
                     for _ in range(processes)]
            try:
                total = sum(each.result(LIMIT) for each in asked)
            except (BrokenProcessPool, RunError, TimeoutError) as error:
                settings.say(f"left out: {kind}: {error or 'no answer'}")
                del rates[kind]
                continue
            if run:  # the first is for opening things
                rates[kind].append(total)
    name = f"{size[0]}x{size[1]}.{processes}"
    found = [figure(f"steps.{kind}.{name}", "1/s", values) for kind, values in rates.items()]
    return found + [ratio(f"ratio.{COARSE}.{kind}.{name}", rates[COARSE], rates[kind])
                    for kind in (TINY, PLUGIN) if kind in rates and COARSE in rates]


def _rate(kind: str, size: tuple[int, int], seconds: float) -> float:
    """In a process of the pool: steps a second over that time."""
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
    os.dup2(os.open(os.devnull, os.O_WRONLY), STDOUT)  # the plugin prints while it draws
    course = CourseWorld()
    described = course.world.description
    course.world.close()
    course.world = World(
        replace(described, physics=replace(described.physics, max_step_size=SUB_STEP)))
    waffle = course.spawn_waffle()
    drive = drive_of(waffle)
    drive.command(SPEED, TURN)
    drawing = PybulletDrawing(course.world.update_scene(), plugin=kind == PLUGIN,
                              fastest=False)

    def step() -> np.ndarray:
        drive.update(SUB_STEPS * SUB_STEP)
        course.world.step(SUB_STEPS)
        course.world.update_scene()
        drawing.place()
        return np.array(drawing.draw(course.view(waffle, *size)))[:, :, :3]

    return step
