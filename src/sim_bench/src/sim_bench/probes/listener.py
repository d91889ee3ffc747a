"""Hears topics, unread, for as long as it runs.

    python3 -m sim_bench.probes.listener OUT TOPIC...

Rewrites OUT once a wall second with a line `TIME MESSAGES BYTES` for each topic, in their order;
TIME is CLOCK_MONOTONIC in s.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import rospy

WRITE_PERIOD = 1.0  # s, wall


class Count:
    """Of one topic's messages."""

    def __init__(self, topic: str):
        self.messages = self.bytes = 0
        rospy.Subscriber(topic, rospy.AnyMsg, self._add, queue_size=1)

    def _add(self, message: rospy.AnyMsg) -> None:
        self.messages += 1
        self.bytes += len(message._buff)


def main() -> None:
    """Until it is ended."""
    rospy.init_node("listener", anonymous=True, disable_rostime=True)
    out, counts = Path(sys.argv[1]), [Count(topic) for topic in rospy.myargv()[2:]]
    while not rospy.is_shutdown():
        rospy.rostime.wallsleep(WRITE_PERIOD)
        fresh = out.with_suffix(".new")
        fresh.write_text("".join(f"{time.monotonic():.6f} {one.messages} {one.bytes}\n"
                                 for one in counts), encoding="ascii")
        fresh.replace(out)  # whole, whenever it is read


if __name__ == "__main__":
    main()
