"""From typing roslaunch to the first image, with a subscriber that is already waiting.

Each run is `roslaunch learning_topic 0course.launch gui:=false` on a port of its own, where
roslaunch starts the master too. The subscriber has all its modules loaded and asks for the master
a hundred times a second, as somebody who has typed `rosrun` before.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

from run_session.failure import RunError
from run_session.master import free_port
from run_session.processes import Child, Family
from sim_bench.figures import Figure, figure
from sim_bench.follower import COURSE_LAUNCH, IMAGES
from sim_bench.ros_run import POLL, START_LIMIT, probe_command, read_lines
from sim_bench.settings import Settings, say

RUNS = 5


def measure(settings: Settings) -> list[Figure]:
    """Seconds on the wall from the start of roslaunch."""
    folder = settings.out / "log" / "startup"
    folder.mkdir(parents=True, exist_ok=True)
    masters, images = zip(*[_start_up(folder) for _ in range(settings.runs(RUNS))])
    return [figure("first_image", "s", images), figure("master", "s", masters)]


def _start_up(folder: Path) -> tuple[float, float]:
    """s until the master answers, and until the first image."""
    say("roslaunch until the first image")
    port, seen = str(free_port(0)), folder / "first_image.txt"
    seen.unlink(missing_ok=True)
    environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}",
                   "ROS_LOG_DIR": str(folder / "ros")}
    with Family() as family:
        probe = family.start("first_image", probe_command("first_image", str(seen), IMAGES),
                             environment, folder / "first_image.log")
        _wait_for_lines(seen, 1, probe)
        began = time.monotonic()
        launched = family.start("roslaunch", ["roslaunch", "-p", port, *COURSE_LAUNCH],
                                environment, folder / "roslaunch.log")
        _wait_for_lines(seen, 3, launched)
    _, (master,), (image,) = read_lines(seen)
    return master - began, image - began


def _wait_for_lines(seen: Path, count: int, child: Child) -> None:
    until = time.monotonic() + START_LIMIT
    while len(read_lines(seen)) < count:
        if time.monotonic() > until or child.process.poll() is not None:
            raise RunError(f"no image within {START_LIMIT:.0f} s; log: {child.log}",
                           child.last_lines())
        time.sleep(POLL)
