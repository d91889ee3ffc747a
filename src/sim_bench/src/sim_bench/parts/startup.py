"""From typing roslaunch to the first image, with a subscriber that is already waiting.

Each run is `roslaunch learning_topic 0course.launch gui:=false` on a port of its own, where
roslaunch starts the master too. The subscriber has all its modules loaded and asks for the master
a hundred times a second, as somebody who has typed `rosrun` before.
"""

from __future__ import annotations

import time

from sim_bench.course_drive import COURSE_LAUNCH, IMAGES
from sim_bench.figures import Figure, figure
from sim_bench.ros_run import START_LIMIT, read_lines, ros_run
from sim_bench.settings import Settings

RUNS = 5
WAITING, MASTER, IMAGE = 0, 1, 2  # lines of the probe's file


def measure(settings: Settings) -> list[Figure]:
    """Seconds on the wall from the start of roslaunch."""
    runs = [_start_up(settings) for _ in range(settings.runs(RUNS))]
    return [
        figure("first_image", "s", [image for _, image in runs]),
        figure("master", "s", [master for master, _ in runs]),
    ]


def _start_up(settings: Settings) -> tuple[float, float]:
    settings.say("roslaunch until the first image")
    with ros_run(settings, "startup", roscore=False) as run:
        file = run.folder / "first_image.txt"
        file.unlink(missing_ok=True)
        probe = run.probe("first_image", str(file), IMAGES)
        run.wait(lambda: len(read_lines(file)) > WAITING, START_LIMIT, "the subscriber")
        began = time.monotonic()
        launched = run.launch(*COURSE_LAUNCH)
        run.wait(lambda: len(read_lines(file)) > IMAGE, START_LIMIT, f"an image on {IMAGES}")
        _, (master,), (image,) = read_lines(file)
        run.forget(probe)
        run.end(launched)
        return master - began, image - began
