"""Runs a lesson as it is, and writes down when its image callback got which frame.

    python3 -m sim_bench.probes.follower OUT LESSON

The lesson's file is run unchanged, in this process: rospy.Subscriber is replaced before by one that
notes each image's arrival at the callback. /clock is noted too, over the connection that rospy has
open anyway. Lines are `0 WALL STAMP WIDTH CALLBACK` for images and `1 WALL TIME 0 0` for /clock, in
s (WALL is CLOCK_MONOTONIC, which all processes share) and px.
"""

from __future__ import annotations

import runpy
import sys
import time
from collections.abc import Callable
from pathlib import Path

import rospy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image

FRAME, CLOCK = 0, 1


def main() -> None:
    """Never returns but through the lesson."""
    out, lesson = Path(sys.argv[1]), sys.argv[2]
    plain = rospy.Subscriber
    with out.open("w", encoding="ascii", buffering=1) as file:

        def noting(callback: Callable[[Image], None]) -> Callable[[Image], None]:
            def note(image: Image) -> None:
                arrived = time.monotonic()
                callback(image)
                took = time.monotonic() - arrived
                stamp = image.header.stamp.to_sec()
                file.write(f"{FRAME} {arrived:.6f} {stamp:.6f} {image.width} {took:.6f}\n")

            return note

        def subscriber(name: str, kind: type, callback: Callable, *rest, **options) -> object:
            wrapped = noting(callback) if kind is Image else callback
            made = plain(name, kind, wrapped, *rest, **options)
            plain("/clock", Clock, note_clock)
            return made

        def note_clock(message: Clock) -> None:
            file.write(f"{CLOCK} {time.monotonic():.6f} {message.clock.to_sec():.6f} 0 0\n")

        rospy.Subscriber = subscriber
        sys.argv = [lesson]
        runpy.run_path(lesson, run_name="__main__")


if __name__ == "__main__":
    main()
