"""The main job over ROS at real-time pace: rates, ages and processor time; and what rest costs.

Lesson 05 drives the waffle, once with its 1920x1080 camera and once at 1280x720. Each run is a
window of wall time: one launch is cut into windows, together about a lap. A lap as `make course`
does it, with film and scoring, comes first. Frames are counted and dated in the lesson's own
process (see `follower`). Processor time is that of each node's process and its children, in percent
of one core; "spare" is what all that was started leaves of the machine's cores; a stage is what the
simulator does for a frame, by its name.
"""

from __future__ import annotations

import os
import statistics

import numpy as np

from run_session import simulator
from sim_bench.figures import Figure, figure
from sim_bench.follower import (
    FOLLOWER,
    IMAGES,
    Follower,
    Seen,
    frame_ages,
    launch_course,
    real_time_factor,
)
from sim_bench.ros_run import (
    PERCENT,
    PROFILE,
    SIMULATOR,
    RosRun,
    Window,
    cpu_figures,
    marked_lap,
    read_lines,
    ros_run,
    stage_figures,
    stages,
)
from sim_bench.settings import Settings, say

SIZES = {"1080p": (1920, 1080), "720p": (1280, 720)}
WINDOWS, WINDOW = {"1080p": 7, "720p": 4}, 10.0  # s, wall
WARM_UP = 3.0  # s, wall, after the first frame
REST_WINDOWS, REST_WINDOW, REST_WARM_UP = 3, 5.0, 3.0  # s, wall


def measure(settings: Settings) -> list[Figure]:
    """Both camera sizes, and the simulator at rest."""
    say("a lap of `make course`")
    report = marked_lap(settings, "make_course")
    answered = report["frames_answered"] / report["wall_s"]
    found = [figure("make_course.real_time_factor", "x", [report["real_time_factor"]]),
             figure("make_course.frames", "frames/s", [answered])]
    with ros_run(settings, "ros") as run:
        for name, size in SIZES.items():
            say(f"lesson 05 with the camera at {size[0]}x{size[1]}")
            found += _drive(run, name, size, settings)
        say("a waffle that stands: its 1920x1080 images sent, nobody subscribed, then paused")
        return found + _rest(run, settings)


def _drive(run: RosRun, name: str, size: tuple[int, int], settings: Settings) -> list[Figure]:
    follower = Follower(run, size, PROFILE)
    follower.wait_until_driving()
    run.pause(WARM_UP)
    windows = run.windows(settings.runs(WINDOWS[name]), settings.seconds(WINDOW))
    return [*drive_figures(name, follower.end(), windows),
            *stage_figures(name, stages(follower.launched.log, turn="send"))]


def drive_figures(name: str, seen: Seen, windows: list[Window]) -> list[Figure]:
    """The figures of these windows."""
    inside = [seen.between(window.start, window.end) for window in windows]
    frames = [len(part.frames) / (window.end - window.start)
              for part, window in zip(inside, windows)]
    ages = [[1e3 * age for age in frame_ages(part.frames, seen.clock)] for part in inside]
    slow = [float(np.percentile(each, 95, method="inverted_cdf")) for each in ages]
    took = [1e3 * np.median(part.frames[:, 2]) for part in inside]
    cores = len(os.sched_getaffinity(0))
    spare = [cores - sum(window.cpu.values()) / 100 for window in windows]
    return [
        figure(f"{name}.frames", "frames/s", frames),
        figure(f"{name}.real_time_factor", "x", [real_time_factor(part.clock) for part in inside]),
        figure(f"{name}.frame_age", "ms", map(statistics.median, ages)),
        figure(f"{name}.frame_age_p95", "ms", slow),
        figure(f"{name}.callback", "ms", took),
        *cpu_figures(name, windows, always=(SIMULATOR, FOLLOWER)),
        figure(f"{name}.spare", "cores", spare),
    ]


def _rest(run: RosRun, settings: Settings) -> list[Figure]:
    """The simulator's processor time while the waffle stands: heard, alone, and paused."""
    launched = launch_course(run)
    file = run.log_folder / "standing.txt"
    listener = run.probe("listener", str(file), IMAGES)
    run.wait(lambda: any(count for (count,) in read_lines(file)), "an image")
    found = []
    for name in ("standing", "idle", "paused"):
        run.pause(REST_WARM_UP)
        windows = run.windows(settings.runs(REST_WINDOWS), settings.seconds(REST_WINDOW))
        found.append(figure(f"{name}.cpu.{SIMULATOR}", PERCENT,
                            [window.cpu.get(SIMULATOR, 0.0) for window in windows]))
        found.append(figure(f"{name}.real_time_factor", "x",
                            [window.factor for window in windows]))
        if name == "standing":
            run.stop(listener)
        else:
            simulator.pause()
    run.stop(launched)
    return found
