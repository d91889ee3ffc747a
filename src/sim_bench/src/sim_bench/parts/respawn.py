"""A waffle spawned and deleted again and again: what stays behind, in memory and in a step's time.

Over the services of a running simulator for its memory; in the core alone, beside a waffle that
drives, for the time of a step.
"""

from __future__ import annotations

import time

from bullet_sim.pose import Pose
from run_session import simulator
from run_session.processes import memory
from sim_bench.course import CourseWorld, drive_of, waffle_text
from sim_bench.figures import Figure, figure, ratio
from sim_bench.parts.memory import growth_percent
from sim_bench.ros_run import SIMULATOR, ros_run
from sim_bench.settings import Settings, say

TIMES, QUICK_TIMES = 1000, 200
LOOKS = 50  # measurements on the way
STEPS = 400  # physics steps of one measurement
SPEED, YAW_RATE = 0.15, 0.3  # m/s, rad/s, of the waffle that stays
ASIDE = Pose((1.0, 1.0, 0.01))


def measure(settings: Settings) -> list[Figure]:
    """Percent of growth, and the time of a step at the end beside that at the beginning."""
    times = QUICK_TIMES if settings.quick else TIMES
    return [_memory(settings, times), _step_time(times)]


def _memory(settings: Settings, times: int) -> Figure:
    text, samples = waffle_text(), []
    with ros_run(settings, "respawn") as run:
        run.launch_world()
        say(f"{times} waffles, one after the other")
        for number in range(times):
            simulator.spawn_urdf("waffle", text, "", 0.0, 0.0)
            simulator.delete("waffle")
            if number % (times // LOOKS) == 0:
                samples.append(memory(SIMULATOR))
                run.check(None)
    return figure("memory.growth", "%", [growth_percent(samples)])


def _step_time(times: int) -> Figure:
    say(f"{times} more, beside one that drives")
    course = CourseWorld()
    drive = drive_of(course.spawn_waffle(), SPEED, YAW_RATE)
    seconds = []
    for number in range(times):
        course.spawn_waffle("other", ASIDE)
        course.world.delete("other")
        if number % (times // LOOKS) == 0:
            drive.update(1 / 30)
            began = time.perf_counter()
            course.world.step(STEPS)
            seconds.append(time.perf_counter() - began)
    course.close()
    fifth = LOOKS // 5
    first, last = seconds[fifth:2 * fifth], seconds[-fifth:]
    return ratio("step.last_to_first", [min(last)], [min(first)])  # others only ever add time
