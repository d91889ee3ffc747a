"""The main job over ROS at real-time pace: rates, ages and processor time; and what rest costs.

Lesson 05 drives the waffle, once with its 1920x1080 camera and once at 1280x720. Each run is a
window of wall time: one launch is cut into windows, together about a lap. A lap as `make course`
does it, with film and scoring, comes first. Frames are counted and
dated in the lesson's own process (see `probes.follower`, `frame_age`). Processor time is that of
each node's process and its children, in percent of one core; "spare" is what all that was
started leaves of the machine's cores; a stage is what the simulator does for a frame, by its name.
"""

from __future__ import annotations

import itertools
import os
import statistics
import time

from run_session import simulator
from run_session.processes import CpuMeter
from sim_bench.course_drive import (
    FOLLOWER,
    SIMULATOR,
    Follower,
    Seen,
    camera_arguments,
    launch_course,
)
from sim_bench.figures import Figure, figure, percentile
from sim_bench.frame_age import frame_ages, real_time_factor
from sim_bench.marked_lap import marked_lap
from sim_bench.ros_run import PERCENT, RosRun, cpu_figures, ros_run
from sim_bench.settings import Settings
from sim_bench.stages import PROFILE, stage_figures, stages

SIZES = {"1080p": (1920, 1080), "720p": (1280, 720)}
WINDOWS, WINDOW = {"1080p": 7, "720p": 4}, 10.0  # s, wall
WARM_UP = 3.0  # s, wall, after the first frame
REST_WINDOWS, REST_WINDOW, REST_WARM_UP = 3, 5.0, 3.0  # s, wall


def measure(settings: Settings) -> list[Figure]:
    """Both camera sizes, and the simulator at rest."""
    found = _make_course(settings)
    with ros_run(settings, "ros") as run:
        for name, size in SIZES.items():
            settings.say(f"lesson 05 with the camera at {size[0]}x{size[1]}")
            found += _drive(run, name, size, settings)
        settings.say("nobody subscribed, then paused")
        return found + _rest(run, settings)


def _make_course(settings: Settings) -> list[Figure]:
    settings.say("a lap of `make course`")
    report = marked_lap(settings, "make_course")
    answered = report["frames_answered"] / report["wall_s"]
    return [
        figure("make_course.real_time_factor", "x", [report["real_time_factor"]]),
        figure("make_course.frames", "frames/s", [answered]),
    ]


def _drive(run: RosRun, name: str, size: tuple[int, int], settings: Settings) -> list[Figure]:
    launched = launch_course(run, *camera_arguments(*size), PROFILE)
    follower = Follower(run, size[0])
    follower.wait_until_driving()
    run.pause(WARM_UP)
    meter, edges, cpu = CpuMeter(), [time.monotonic()], []
    for _ in range(settings.runs(WINDOWS[name])):
        run.pause(settings.seconds(WINDOW))
        cpu.append(meter.look())
        edges.append(time.monotonic())
    run.end(follower.child)
    run.end(launched)
    return [*drive_figures(name, follower.seen(), edges, cpu),
            *stage_figures(name, stages(launched.log, turn="send"))]


def drive_figures(
    name: str, seen: Seen, edges: list[float], cpu: list[dict[str, float]]
) -> list[Figure]:
    """The figures of windows between these wall times (s), with what `CpuMeter` saw in each."""
    windows = [(seen.between(*pair), pair[1] - pair[0]) for pair in itertools.pairwise(edges)]
    ages = [_ages_ms(window, seen) for window, _ in windows]
    took = [1e3 * statistics.median(window.callbacks) for window, _ in windows]
    figures = [
        figure(f"{name}.frames", "frames/s", [len(w.frames) / long for w, long in windows]),
        figure(f"{name}.real_time_factor", "x", [real_time_factor(w.clock) for w, _ in windows]),
        figure(f"{name}.frame_age", "ms", [statistics.median(window) for window in ages]),
        figure(f"{name}.frame_age_p95", "ms", [percentile(window, 0.95) for window in ages]),
        figure(f"{name}.callback", "ms", took),
    ]
    cores = len(os.sched_getaffinity(0))
    spare = [cores - sum(window.values()) / 100 for window in cpu]
    return [*figures, *cpu_figures(name, cpu, always=(SIMULATOR, FOLLOWER)),
            figure(f"{name}.spare", "cores", spare)]


def _ages_ms(window: Seen, whole: Seen) -> list[float]:
    return [1e3 * age for age in frame_ages(window.frames, whole.clock)]


def _rest(run: RosRun, settings: Settings) -> list[Figure]:
    """The simulator's processor time while nothing is asked of it."""
    launched = launch_course(run)
    found = []
    for name in ("idle", "paused"):
        run.pause(REST_WARM_UP)
        cpu, factors = [], []
        for _ in range(settings.runs(REST_WINDOWS)):
            began, simulated, meter = time.monotonic(), simulator.simulated_time(), CpuMeter()
            run.pause(settings.seconds(REST_WINDOW))
            cpu.append(meter.look().get(SIMULATOR, 0.0))
            passed = simulator.simulated_time() - simulated
            factors.append(passed / (time.monotonic() - began))
        found.append(figure(f"{name}.cpu.{SIMULATOR}", PERCENT, cpu))
        found.append(figure(f"{name}.real_time_factor", "x", factors))
        simulator.pause()
    run.end(launched)
    return found
