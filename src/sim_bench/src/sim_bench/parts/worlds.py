"""Worlds as public ones are made (made_worlds.py), at work over ROS with all sensors heard.

The real-time factor of each while one other process hears it; of the road with signs for different
numbers of triangles. Stages are of one picture of one camera, and begin with a processor that has
slept; a frame is what the simulator logs of each camera: pictures drawn one after another.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from pathlib import Path

from run_session import simulator
from run_session.processes import CpuMeter
from sim_bench import made_worlds
from sim_bench.figures import Figure, figure
from sim_bench.made_worlds import MadeWorld
from sim_bench.ros_run import START_LIMIT, RosRun, cpu_figures, read_lines, ros_run
from sim_bench.settings import Settings
from sim_bench.stages import PROFILE, stage_figures, stages

TRIANGLES = (30_000, 100_000, 300_000, 1_000_000)
RUNS, WINDOW, SETTLING = 3, 6.0, 3.0  # s, wall
DRAWING = ("draw", "read back", "convert")
FRAME = re.compile(r"camera \S+ \(\d+x\d+\): ([\d.]+) ms a frame")  # as the simulator logs it

WORLDS: dict[str, Callable[[Path], MadeWorld]] = {
    **{f"signs.{count}": lambda folder, count=count: made_worlds.signs(folder, count)
       for count in TRIANGLES},
    "four_cameras_and_rings": made_worlds.many_eyes,
    "depth.640x480": lambda folder: made_worlds.depth(folder, 640, 480),
    "depth.1920x1080": lambda folder: made_worlds.depth(folder, 1920, 1080),
    "playpen.4_wheels": lambda folder: made_worlds.playpen(folder, 4),
    "playpen.6_wheels": lambda folder: made_worlds.playpen(folder, 6),
}


def measure(settings: Settings) -> list[Figure]:
    """Simulated seconds in one on the wall, by world."""
    found = []
    for name, make in WORLDS.items():
        settings.say(name)
        with ros_run(settings, f"worlds/{name}", roscore=False) as run:
            factors, cpu, log = _at_work(run, make(run.folder), settings)
        work = stages(log, turn="draw")
        found += [figure(f"real_time_factor.{name}", "x", factors), *stage_figures(name, work),
                  *cpu_figures(name, cpu)]
        if work:
            drawing = sum(work.get(stage, 0.0) for stage in DRAWING)
            found.append(figure(f"frame_at_work.{name}", "ms", [drawing]))
        if said := FRAME.findall(log.read_text(encoding="utf-8", errors="replace")):
            found.append(figure(f"frame.{name}", "ms", map(float, said)))
    return found


def _at_work(run: RosRun, world: MadeWorld,
             settings: Settings) -> tuple[list[float], list[dict[str, float]], Path]:
    """Real-time factors, each process's share of a core (%), and what was logged meanwhile."""
    launched = run.launch("gazebo_ros", "empty_world.launch", "gui:=false", PROFILE,
                          f"world_name:={world.file}")
    run.wait(simulator.models, START_LIMIT, "the simulator")
    if world.topics:
        heard = run.folder / "heard.txt"
        run.probe("listener", str(heard), *world.topics)
        run.wait(lambda: _all_heard(heard, len(world.topics)), START_LIMIT, "all sensors")
    run.pause(settings.seconds(SETTLING))
    factors, cpu, meter = [], [], CpuMeter()
    for _ in range(settings.runs(RUNS)):
        began, start = time.monotonic(), simulator.simulated_time()
        run.pause(settings.seconds(WINDOW))
        factors.append((simulator.simulated_time() - start) / (time.monotonic() - began))
        cpu.append(meter.look())
    run.end(launched)
    return factors, cpu, launched.log


def _all_heard(file: Path, topics: int) -> bool:
    lines = read_lines(file)
    return len(lines) == topics and all(messages > 0 for _, messages, _ in lines)
