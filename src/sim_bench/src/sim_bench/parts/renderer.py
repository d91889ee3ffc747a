"""Our renderer beside PyBullet's two, on the course with its waffle, and beside the truth.

All three draw the same scene from the same places of a lap, taking turns at each place, each in a
process of its own. Ours is timed with everything the simulator does for a frame: the scene's poses,
drawing, reading back, RGB. PyBullet's are timed by getCameraImage alone.
"""

from __future__ import annotations

import statistics

from sim_bench import analytic
from sim_bench.course import CourseWorld
from sim_bench.drawing import OURS, SAYS, Task, draw, renderer_name
from sim_bench.figures import Figure, figure, ratio
from sim_bench.own_process import Contest
from sim_bench.settings import Settings, say

SIZES = ((320, 240), (640, 480), (1280, 720), (1920, 1080))  # px
RUNS, FRAMES = 5, 3  # places of a lap; timed frames of each turn, of which the median counts
COMPARED_SIZE, COMPARED_PLACES = (1920, 1080), 3


def measure(settings: Settings) -> list[Figure]:
    """Milliseconds a frame, how many times ours the others take, and grey levels off the truth."""
    with Contest(SAYS) as contest:
        say("drawn by " + "; ".join(name for (name,) in contest.turn(renderer_name).values()))
        found = []
        for size in SIZES:
            say(f"drawing {size[0]}x{size[1]}")
            found += _frame_times(contest, size, settings)
        say("comparing with the analytic picture")
        return found + _differences(contest, settings)


def _frame_times(contest: Contest, size: tuple[int, int], settings: Settings) -> list[Figure]:
    runs, frames = settings.runs(RUNS), 1 if settings.quick else FRAMES
    contest.turn(draw, Task(*size, 0.0, 1))  # shaders are compiled for what is drawn first
    turns = [contest.turn(draw, Task(*size, run / runs, frames)) for run in range(runs)]
    times = {kind: [1e3 * statistics.median(turn[kind][0][0]) for turn in turns]
             for kind in turns[-1]}
    name = f"{size[0]}x{size[1]}"
    found = [figure(f"frame.{kind}.{name}", "ms", values) for kind, values in times.items()]
    return found + [ratio(f"ratio.{kind}.{name}", values, times[OURS])
                    for kind, values in times.items() if kind != OURS]


def _differences(contest: Contest, settings: Settings) -> list[Figure]:
    """Away from edges, at some places of a lap: the greatest difference in grey levels."""
    course = CourseWorld()
    waffle = course.spawn_waffle()
    worst = []
    for place in range(1 if settings.quick else COMPARED_PLACES):
        lap_share = place / COMPARED_PLACES
        ((_, picture),) = contest.turn(draw, Task(*COMPARED_SIZE, lap_share, frames=0))[OURS]
        course.put_on_line(waffle, lap_share)
        truth = analytic.render(course.world.description, course.view(waffle, *COMPARED_SIZE))
        worst.append(float(analytic.difference(picture, truth)[truth.clear].max()))
    course.close()
    return [figure("difference.max", "grey levels", worst)]
