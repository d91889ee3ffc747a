"""The main job over ROS at real-time pace: rates, ages and processor time; and what rest costs.

Lesson 05 drives the waffle, once with its 1920x1080 camera and once at 1280x720. Each run is a
window of wall time: one launch is cut into windows, together about a lap. A lap as `make course`
does it, with film and scoring, comes first. Frames are counted and dated in the lesson's own
process (see `follower`). Processor time is that of each node's process and its children, in percent
of one core; "spare" is what all that was started leaves of the machine's cores; a stage is what the
simulator does for a frame, by its name. `limit.cpu` is what llvmpipe and the engine's bare steps
take of the simulator's.
"""

from __future__ import annotations

import os
import re
import statistics
import time
from pathlib import Path

import numpy as np

from run_session import simulator
from run_session.processes import processes
from sim_bench.figures import Figure, figure
from sim_bench.follower import FOLLOWER, IMAGES, Follower, Seen, frame_ages, launch_course
from sim_bench.parts.step import STEP, bare_step_time
from sim_bench.ros_run import (
    PERCENT,
    PROFILE,
    SIMULATOR,
    RosRun,
    Window,
    cpu_figures,
    marked_lap,
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
            found += _drive(run, name, size)
        say("a waffle that stands: its 1920x1080 images sent, nobody subscribed, then paused")
        return found + _rest(run)


def _drive(run: RosRun, name: str, size: tuple[int, int]) -> list[Figure]:
    follower = Follower(run, size, PROFILE)
    began, spent = time.monotonic(), _drawing_time()
    windows = run.windows(WINDOWS[name], WINDOW, WARM_UP)
    drawing = (_drawing_time() - spent) / (time.monotonic() - began)
    return [*drive_figures(name, follower.end(), windows),
            figure(f"{name}.limit.cpu", PERCENT, [100 * (drawing + bare_step_time() / STEP)]),
            *stage_figures(name, stages(follower.launched.log, turn="send"))]


def _drawing_time() -> float:
    """s of processor time that the simulator's threads of llvmpipe have taken so far."""
    ticks = 0
    for process in processes():
        if process.name == SIMULATOR:
            for thread in Path(f"/proc/{process.pid}/task").iterdir():
                _, name, rest = re.split(r"[()]", (thread / "stat").read_text(), maxsplit=2)
                if name.startswith("llvmpipe"):
                    ticks += sum(map(int, rest.split()[11:13]))
    return ticks / os.sysconf("SC_CLK_TCK")


def drive_figures(name: str, seen: Seen, windows: list[Window]) -> list[Figure]:
    """The figures of these windows."""
    inside = [seen.frames_between(window.start, window.end) for window in windows]
    rates = [len(frames) / (window.end - window.start) for frames, window in zip(inside, windows)]
    ages = [1e3 * statistics.median(frame_ages(frames, seen.clock)) for frames in inside]
    took = [1e3 * np.median(frames[:, 2]) for frames in inside]
    cores = len(os.sched_getaffinity(0))
    spare = [cores - sum(window.cpu.values()) / 100 for window in windows]
    return [
        figure(f"{name}.frames", "frames/s", rates),
        figure(f"{name}.real_time_factor", "x", [window.factor for window in windows]),
        figure(f"{name}.frame_age", "ms", ages),
        figure(f"{name}.callback", "ms", took),
        *cpu_figures(name, windows, always=(SIMULATOR, FOLLOWER)),
        figure(f"{name}.spare", "cores", spare),
    ]


def _rest(run: RosRun) -> list[Figure]:
    """The simulator's processor time while the waffle stands: heard, alone, and paused."""
    launched = launch_course(run)
    listener, found = run.listen(IMAGES), []
    for name in ("standing", "idle", "paused"):
        found.append(figure(f"{name}.cpu.{SIMULATOR}", PERCENT, [
            window.cpu.get(SIMULATOR, 0.0)
            for window in run.windows(REST_WINDOWS, REST_WINDOW, REST_WARM_UP)]))
        if name == "standing":
            run.stop(listener)
        else:
            simulator.pause()
    run.stop(launched)
    return found
