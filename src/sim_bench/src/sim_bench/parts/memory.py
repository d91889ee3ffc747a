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
CLOCK_WAIT = 2.5  # s, wall, until the probe has written what came last
SAY_PERIOD = 30.0  # s, wall
Samples = list[tuple[float, int]]  # simulated s, bytes


def measure(settings: Settings) -> list[Figure]:
    """Percent of growth, megabytes, and nanoseconds that /clock is off."""
    length = settings.seconds(settings.memory_s)
    with ros_run(settings, "memory") as run:
        say(f"{length:g} simulated s without a camera")
        plain, drift = _without_camera(run, length)
        say(f"{CAMERA_SHARE * length:g} simulated s with a camera in lockstep")
        camera = _with_camera(run, CAMERA_SHARE * length)
    return [*_figures("no_camera", plain), *_figures("camera", camera), *drift]


def growth_percent(samples: Sequence[tuple[float, int]]) -> float:
    """From the second tenth of (simulated s, bytes) samples to the last, by their medians."""
    tenth = max(1, len(samples) // 10)
    if len(samples) < 3 * tenth:
        raise ValueError(f"{len(samples)} samples are too few for a growth")
    early = statistics.median(size for _, size in samples[tenth : 2 * tenth])
    late = statistics.median(size for _, size in samples[-tenth:])
    return 100.0 * (late - early) / early


def _without_camera(run: RosRun, length: float) -> tuple[Samples, list[Figure]]:
    launched = launch_course(run, *FAST)
    file = run.log_folder / "clock.txt"
    probe = run.probe("clock", str(file), str(CLOCK_PERIOD_NS))
    circle = send_circle(run)
    simulator.unpause()
    samples = _sample(run, length)
    simulator.pause()
    run.pause(CLOCK_WAIT)
    ((_, last_ns, off_ns),) = read_lines(file)
    behind = simulator.simulated_time() - last_ns * 1e-9
    run.stop(circle, probe, launched)
    return samples, [
        figure("clock.off_whole_periods", "ns", [off_ns]),
        figure("clock.behind_ticks", "ms", [1e3 * behind]),
    ]


def _with_camera(run: RosRun, length: float) -> Samples:
    follower = Follower(run, SIZE, *LOCKSTEP)
    follower.unpause()
    samples = _sample(run, length)
    follower.end()
    return samples


def _sample(run: RosRun, length: float) -> Samples:
    """The simulator's memory at even steps of simulated time, until so much has passed."""
    begin = simulator.simulated_time()
    samples, reported_at = [], time.monotonic()
    while (passed := simulator.simulated_time() - begin) < length:
        if passed >= len(samples) * length / LOOKS:
            samples.append((passed, memory(SIMULATOR)))
        if time.monotonic() - reported_at > SAY_PERIOD:
            reported_at = time.monotonic()
            say(f"  {passed:.0f} of {length:.0f} simulated s")
        run.pause(0.1)
    return samples


def _figures(name: str, samples: Samples) -> list[Figure]:
    megabytes = [size / 1e6 for _, size in samples]
    return [
        figure(f"{name}.growth", "%", [growth_percent(samples)]),
        figure(f"{name}.memory", "MB", megabytes),
    ]
