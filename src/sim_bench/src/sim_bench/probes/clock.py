"""Watches /clock for as long as it runs: are its times whole periods, and how far has it come?

    python3 -m sim_bench.probes.clock OUT PERIOD_NS

Rewrites OUT once a wall second with one line: `MESSAGES LAST_NS WORST_OFF_NS`, the number of
messages, the last time, and the greatest distance of a time from a whole number of periods.
"""

from __future__ import annotations

import sys
from pathlib import Path

import rospy
from rosgraph_msgs.msg import Clock

WRITE_PERIOD = 1.0  # s, wall


class ClockStatistics:
    """What /clock has published so far."""

    def __init__(self, period_ns: int):
        self._period_ns = period_ns
        self.messages = self.last_ns = self.worst_off_ns = 0

    def add(self, time_ns: int) -> None:
        """One message."""
        off = time_ns % self._period_ns
        self.messages += 1
        self.last_ns = time_ns
        self.worst_off_ns = max(self.worst_off_ns, min(off, self._period_ns - off))

    def line(self) -> str:
        """For the file."""
        return f"{self.messages} {self.last_ns} {self.worst_off_ns}\n"


def main() -> None:
    """Until it is ended."""
    out, statistics = Path(sys.argv[1]), ClockStatistics(int(sys.argv[2]))
    rospy.init_node("clock_watch", anonymous=True, disable_rostime=True)
    rospy.Subscriber("/clock", Clock, lambda message: statistics.add(message.clock.to_nsec()))
    while not rospy.is_shutdown():
        rospy.rostime.wallsleep(WRITE_PERIOD)
        fresh = out.with_suffix(".new")
        fresh.write_text(statistics.line(), encoding="ascii")
        fresh.replace(out)  # whole, whenever it is read


if __name__ == "__main__":
    main()
