"""Our renderer beside PyBullet's two, on the course with its waffle, and beside the truth.

All three draw the same scene from the same places of a lap, taking turns at each place, each in a
process of its own. Ours is timed with everything the simulator does for a frame: the scene's poses,
drawing, reading back, RGB. PyBullet's are timed by getCameraImage alone.
"""

from __future__ import annotations

import contextlib
import statistics

from run_session.failure import RunError
from sim_bench import analytic
from sim_bench.course import CourseWorld
from sim_bench.drawing import OURS, PLUGIN, SAYS, TINY, Task, draw, renderer_name
from sim_bench.figures import Figure, figure, ratio
from sim_bench.own_process import OwnProcess
from sim_bench.settings import Settings, say

SIZES = ((320, 240), (640, 480), (1280, 720), (1920, 1080))  # px
RUNS, FRAMES = 5, 3  # places of a lap; timed frames of each turn, of which the median counts
COMPARED_SIZE, COMPARED_PLACES = (1920, 1080), 3


def measure(settings: Settings) -> list[Figure]:
    """Milliseconds a frame, how many times ours the others take, and grey levels off the truth."""
    with contextlib.ExitStack() as stack:
        contenders, names = {}, []
        for kind in (OURS, TINY, PLUGIN):
            process = stack.enter_context(OwnProcess(SAYS[kind]))
            try:
                names += process.call(renderer_name, kind)
                contenders[kind] = process
            except RunError as error:
                if kind == OURS:
                    raise
                say(f"left out: {error}")
        say("drawn by " + "; ".join(names))
        found = []
        for size in SIZES:
            say(f"drawing {size[0]}x{size[1]}")
            found += _frame_times(contenders, size, settings)
        say("comparing with the analytic picture")
        return found + _differences(contenders[OURS], settings)


def _frame_times(contenders: dict[str, OwnProcess], size: tuple[int, int],
                 settings: Settings) -> list[Figure]:
    runs = settings.runs(RUNS)
    for kind, process in contenders.items():  # shaders are compiled for what is drawn first
        process.call(draw, kind, Task(*size, lap_share=0.0, frames=1))
    times: dict[str, list[float]] = {kind: [] for kind in contenders}
    for run in range(runs):
        task = Task(*size, lap_share=run / runs, frames=1 if settings.quick else FRAMES)
        for kind, process in contenders.items():
            ((seconds, _),) = process.call(draw, kind, task)
            times[kind].append(1e3 * statistics.median(seconds))
    name = f"{size[0]}x{size[1]}"
    found = [figure(f"frame.{kind}.{name}", "ms", values) for kind, values in times.items()]
    others = [kind for kind in (TINY, PLUGIN) if kind in times]
    return found + [ratio(f"ratio.{kind}.{name}", times[kind], times[OURS]) for kind in others]


def _differences(ours: OwnProcess, settings: Settings) -> list[Figure]:
    """Away from edges, at some places of a lap: the greatest difference in grey levels."""
    course = CourseWorld()
    waffle = course.spawn_waffle()
    worst = []
    for place in range(1 if settings.quick else COMPARED_PLACES):
        lap_share = place / COMPARED_PLACES
        ((_, picture),) = ours.call(draw, OURS, Task(*COMPARED_SIZE, lap_share, frames=0))
        course.put_on_line(waffle, lap_share)
        truth = analytic.render(course.world.description, course.view(waffle, *COMPARED_SIZE))
        worst.append(float(analytic.difference(picture, truth)[truth.clear].max()))
    course.close()
    return [figure("difference.max", "grey levels", worst)]
