"""Waits for a master that is not there yet, then for the first image, and writes down both.

    python3 -m sim_bench.probes.first_image OUT TOPIC

One line each: `WALL` when it begins to wait, when the master answers, when the first image is here,
in s (CLOCK_MONOTONIC).
"""

from __future__ import annotations

import sys
import threading
import time
from pathlib import Path

import rosgraph
import rospy
from sensor_msgs.msg import Image

POLL = 0.01  # s, wall


def main() -> None:
    """Ends after the first image."""
    topic, there = sys.argv[2], threading.Event()
    with Path(sys.argv[1]).open("w", encoding="ascii", buffering=1) as file:

        def note() -> None:
            file.write(f"{time.monotonic():.6f}\n")

        note()
        while not rosgraph.is_master_online():
            time.sleep(POLL)
        note()
        rospy.init_node("first_image", anonymous=True, disable_rostime=True)

        def got(_image: Image) -> None:
            if not there.is_set():
                note()
                there.set()

        rospy.Subscriber(topic, Image, got, queue_size=1, buff_size=2**24)
        while not there.wait(POLL) and not rospy.is_shutdown():
            pass


if __name__ == "__main__":
    main()
