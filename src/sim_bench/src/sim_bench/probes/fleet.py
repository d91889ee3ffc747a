"""Subscribes to odometry and scan of many robots, and writes down when each came first.

    python3 -m sim_bench.probes.fleet OUT NAMESPACE...

A line `WALL` in s (CLOCK_MONOTONIC) when all subscriptions are made, then one for each topic that
has spoken.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan


def main() -> None:
    """Stays until it is ended: the robots go on having subscribers."""
    rospy.init_node("fleet", anonymous=True, disable_rostime=True)
    received: set[str] = set()
    lock = threading.Lock()  # each topic calls back on a thread of its own
    with Path(sys.argv[1]).open("w", encoding="ascii", buffering=1) as file:

        def first(topic: str) -> Callable[[object], None]:
            def note(_message: object) -> None:
                with lock:
                    if topic not in received:
                        received.add(topic)
                        file.write(f"{time.monotonic():.6f}\n")

            return note

        for namespace in rospy.myargv()[2:]:
            for name, kind in (("odom", Odometry), ("scan", LaserScan)):
                topic = f"/{namespace}/{name}"
                rospy.Subscriber(topic, kind, first(topic), queue_size=1)
        with lock:
            file.write(f"{time.monotonic():.6f}\n")
        rospy.spin()


if __name__ == "__main__":
    main()
