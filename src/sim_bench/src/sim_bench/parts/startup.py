"""From typing roslaunch to the first image, with a subscriber that is already waiting.

Each run is `roslaunch learning_topic 0course.launch gui:=false` on a port of its own, where
roslaunch starts the master too. The subscriber has all its modules loaded and asks for the master
a hundred times a second, as somebody who has typed `rosrun` before.
"""

from __future__ import annotations

import time

from run_session.processes import Family
from sim_bench.figures import Figure, figure
from sim_bench.follower import COURSE_LAUNCH, IMAGES
from sim_bench.ros_run import RosRun, read_lines
from sim_bench.settings import Settings, say

RUNS = 5


def measure(settings: Settings) -> list[Figure]:
    """Seconds on the wall from the start of roslaunch."""
    return [figure("first_image", "s", [_start_up(settings) for _ in range(settings.runs(RUNS))])]


def _start_up(settings: Settings) -> float:
    say("roslaunch until the first image")
    with Family() as family:
        run = RosRun(family, settings, "startup")
        seen = run.log_folder / "first_image.txt"
        run.probe("first_image", str(seen), IMAGES)
        run.wait(lambda: read_lines(seen), "the subscriber")
        began = time.monotonic()
        run.start("roscore", ["roslaunch", "-p", str(run.port), *COURSE_LAUNCH])  # is the master's
        run.wait(lambda: len(read_lines(seen)) > 1, "the first image")
        return read_lines(seen)[-1][0] - began
