"""Worlds as public ones are made (made_worlds.py), at work over ROS with all sensors heard.

The real-time factor of each while one other process hears it; of the road with signs for different
numbers of triangles. Stages are of one picture of one camera, and begin with a processor that has
slept; a frame is what the simulator logs of each camera: pictures drawn one after another.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from sim_bench import made_worlds
from sim_bench.figures import Figure, figure
from sim_bench.made_worlds import MadeWorld
from sim_bench.ros_run import (
    PROFILE,
    RosRun,
    Window,
    cpu_figures,
    ros_run,
    stage_figures,
    stages,
)
from sim_bench.settings import Settings, say

TRIANGLES = (30_000, 100_000, 300_000, 1_000_000)
RUNS, WINDOW, SETTLING = 3, 6.0, 3.0  # s, wall
DRAWING = ("submit", "draw", "read back", "convert")
FRAME = re.compile(r"camera \S+ \(\d+x\d+\): ([\d.]+) ms a frame")  # as the simulator logs it

WORLDS: dict[str, Callable[[Path], MadeWorld]] = {
    **{f"signs.{count}": partial(made_worlds.signs, triangles=count) for count in TRIANGLES},
    "four_cameras_and_rings": made_worlds.many_eyes,
    "depth.640x480": partial(made_worlds.depth, width=640, height=480),
    "depth.1920x1080": partial(made_worlds.depth, width=1920, height=1080),
    "playpen.4_wheels": partial(made_worlds.playpen, wheels=4),
    "playpen.6_wheels": partial(made_worlds.playpen, wheels=6),
}


def measure(settings: Settings) -> list[Figure]:
    """Simulated seconds in one on the wall, by world."""
    found = []
    for name, make in WORLDS.items():
        say(name)
        with ros_run(settings, f"worlds/{name}") as run:
            windows, log = _at_work(run, make(run.log_folder))
        work = stages(log, turn="draw")
        found += [figure(f"real_time_factor.{name}", "x", [window.factor for window in windows]),
                  *stage_figures(name, work), *cpu_figures(name, windows)]
        if work:
            drawing = sum(work.get(stage, 0.0) for stage in DRAWING)
            found.append(figure(f"frame_at_work.{name}", "ms", [drawing]))
        if said := FRAME.findall(log.read_text(encoding="utf-8", errors="replace")):
            found.append(figure(f"frame.{name}", "ms", map(float, said)))
    return found


def _at_work(run: RosRun, world: MadeWorld) -> tuple[list[Window], Path]:
    """What was measured, and the log of what the simulator said meanwhile."""
    launched = run.launch_world(PROFILE, f"world_name:={world.file}")
    if world.topics:
        run.listen(*world.topics)
    windows = run.windows(RUNS, WINDOW, SETTLING)
    run.stop(launched)
    return windows, launched.log
