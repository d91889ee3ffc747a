"""Memory of the simulator over a long simulated time at full speed, and whether /clock drifts.

Two legs, each with the waffle driving: without a camera subscriber for MEMORY_S simulated seconds,
and with lesson 05 in lockstep at 640x480 for a quarter of that. Growth is from the second tenth of
a leg to its last; the first tenth, in which caches fill, is not counted. At the end of the first
leg the world is paused: /clock must then be less than one of its periods behind the world's ticks,
and every time that it published a whole number of periods.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence

import numpy as np

from run_session import simulator
from run_session.processes import memory
from sim_bench.figures import Figure, figure
from sim_bench.follower import FAST, LOCKSTEP, Follower, launch_course, send_circle
from sim_bench.ros_run import SIMULATOR, RosRun, read_lines, ros_run
from sim_bench.settings import Settings, say

SIZE = (640, 480)  # px
LOOKS = 200  # at the memory, over a leg
CAMERA_SHARE = 0.25  # of MEMORY_S, for the leg with the camera
CLOCK_PERIOD_NS = 10_000_000  # 100 Hz of simulated time, the launch file's default
CLOCK_WAIT = 1.0  # s, wall, until the probe has written what came last
SAY_PERIOD = 30.0  # s, wall


def measure(settings: Settings) -> list[Figure]:
    """Percent of growth, and nanoseconds and milliseconds that /clock is off."""
    length = settings.seconds(settings.memory_s)
    with ros_run(settings, "memory") as run:
        say(f"{length:g} simulated s without a camera")
        found = _without_camera(run, length)
        say(f"{CAMERA_SHARE * length:g} simulated s with a camera in lockstep")
        follower = Follower(run, SIZE, *LOCKSTEP)
        found.insert(1, _growth("camera", run, CAMERA_SHARE * length))
        follower.end()
    return found


def growth_percent(sizes: Sequence[float]) -> float:
    """From the second tenth of the samples to the last, by their medians."""
    tenth = max(1, len(sizes) // 10)
    if len(sizes) < 3 * tenth:
        raise ValueError(f"{len(sizes)} samples are too few for a growth")
    early = statistics.median(sizes[tenth : 2 * tenth])
    return 100.0 * (statistics.median(sizes[-tenth:]) - early) / early


def _without_camera(run: RosRun, length: float) -> list[Figure]:
    launched = launch_course(run, *FAST)
    file = run.log_folder / "clock.txt"
    probe = run.probe("clock", str(file))
    circle = send_circle(run)
    simulator.unpause()
    growth = _growth("no_camera", run, length)
    simulator.pause()
    run.pause(CLOCK_WAIT)
    times = np.ravel(read_lines(file))
    behind = simulator.simulated_time() - 1e-9 * times[-1]
    run.stop(circle, probe, launched)
    return [growth, figure("clock.off_whole_periods", "ns", [off_whole_periods(times)]),
            figure("clock.behind_ticks", "ms", [1e3 * behind])]


def off_whole_periods(times: np.ndarray) -> float:
    """The worst distance (ns) of a time of /clock from a whole number of its periods."""
    off = times % CLOCK_PERIOD_NS
    return float(np.minimum(off, CLOCK_PERIOD_NS - off).max())


def _growth(name: str, run: RosRun, length: float) -> Figure:
    """Growth of the simulator's memory, taken at even steps in `length` s of simulated time."""
    begin = simulator.simulated_time()
    samples, reported_at = [], time.monotonic()
    while (passed := simulator.simulated_time() - begin) < length:
        if passed >= len(samples) * length / LOOKS:
            samples.append(memory(SIMULATOR))
        if time.monotonic() - reported_at > SAY_PERIOD:
            reported_at = time.monotonic()
            say(f"  {passed:.0f} of {length:.0f} simulated s")
        run.pause(0.1)
    return figure(f"{name}.growth", "%", [growth_percent(samples)])
