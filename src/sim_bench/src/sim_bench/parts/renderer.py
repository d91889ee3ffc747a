"""Our renderer beside PyBullet's two, on the course with its waffle, and beside the truth.

All three draw the same scene from the same places of a lap, taking turns at each place, each in a
process of its own. Ours is timed with everything the simulator does for a frame: the scene's poses,
drawing, reading back, RGB. PyBullet's are timed by getCameraImage alone.
"""

from __future__ import annotations

import statistics

from run_session.failure import RunError
from sim_bench import analytic
from sim_bench.course import CourseWorld
from sim_bench.drawing_process import OURS, PLUGIN, TINY, DrawingProcess, Task
from sim_bench.figures import Figure, figure, ratio
from sim_bench.settings import Settings

SIZES = ((320, 240), (640, 480), (1280, 720), (1920, 1080))  # px
RUNS, FRAMES = 5, 3  # places of a lap; timed frames of each turn, of which the median counts
COMPARED_SIZE, COMPARED_PLACES = (1920, 1080), 3


def measure(settings: Settings) -> list[Figure]:
    """Milliseconds a frame, how many times ours the others take, and grey levels off the truth."""
    contenders = _open(settings)
    try:
        found = []
        for size in SIZES:
            settings.say(f"drawing {size[0]}x{size[1]}")
            found += _frame_times(contenders, size, settings)
        settings.say("comparing with the analytic picture")
        return found + _differences(contenders[0], settings)
    finally:
        for contender in contenders:
            contender.close()


def _open(settings: Settings) -> list[DrawingProcess]:
    """Ours first; one of PyBullet's that does not start is left out, with a line."""
    contenders = [DrawingProcess(OURS)]
    for kind in (TINY, PLUGIN):
        try:
            contenders.append(DrawingProcess(kind))
        except RunError as error:
            settings.say(f"left out: {error}")
    settings.say("drawn by " + "; ".join(contender.name for contender in contenders))
    return contenders


def _frame_times(
    contenders: list[DrawingProcess], size: tuple[int, int], settings: Settings
) -> list[Figure]:
    runs = settings.runs(RUNS)
    for contender in contenders:  # shaders are compiled for what is drawn first
        contender.draw(Task(*size, lap_share=0.0, frames=1))
    times: dict[str, list[float]] = {contender.kind: [] for contender in contenders}
    for run in range(runs):
        task = Task(*size, lap_share=run / runs, frames=1 if settings.quick else FRAMES)
        for contender in contenders:
            milliseconds = statistics.median(contender.draw(task).seconds) * 1e3
            times[contender.kind].append(milliseconds)
    name = f"{size[0]}x{size[1]}"
    found = [figure(f"frame.{kind}.{name}", "ms", values) for kind, values in times.items()]
    others = [kind for kind in (TINY, PLUGIN) if kind in times]
    return found + [ratio(f"ratio.{kind}.{name}", times[kind], times[OURS]) for kind in others]


def _differences(ours: DrawingProcess, settings: Settings) -> list[Figure]:
    """Away from edges, at some places of a lap: the greatest difference in grey levels."""
    course = CourseWorld()
    waffle = course.spawn_waffle()
    worst = []
    for place in range(1 if settings.quick else COMPARED_PLACES):
        lap_share = place / COMPARED_PLACES
        task = Task(*COMPARED_SIZE, lap_share, frames=0, want_picture=True)
        course.put_on_line(waffle, lap_share)
        truth = analytic.render(
            course.world.description, course.view(waffle, *COMPARED_SIZE)
        )
        off = analytic.difference(ours.draw(task).picture, truth)[truth.clear]
        worst.append(float(off.max()))
    course.close()
    return [figure("difference.max", "grey levels", worst)]
