#!/usr/bin/env python3
"""Counts the pictures that a page gets, and what they cost server and world: no test, it measures.

    python3 src/sim/sim_viewer/test/stream_rate.py [--topic /camera/rgb/image_raw] [--seconds 10]

The page must run; its address comes from the parameter /sim_viewer/url.
"""

import argparse
import os
import time
import xmlrpc.client
from pathlib import Path

import rosgraph
import rospy
from page_link import PageLink
from rosgraph_msgs.msg import Clock

NODE = "/sim_viewer"
TICK = os.sysconf("SC_CLK_TCK")


def processor_seconds(pid: int) -> float:
    """Of all threads of a process, user and system, so far."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICK


class WorldClock:
    """Simulated time by /clock."""

    def __init__(self) -> None:
        self._now = 0.0
        rospy.Subscriber("/clock", Clock, self._take)

    def _take(self, message: Clock) -> None:
        self._now = message.clock.to_sec()

    def factor(self, seconds: float) -> float:
        """Simulated s a s, over so many seconds."""
        began, before = time.monotonic(), self._now
        time.sleep(seconds)
        return (self._now - before) / (time.monotonic() - began)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--topic", default="/camera/rgb/image_raw")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--poses", action="store_true", help="watch the 3D view's poses too")
    given = parser.parse_args()
    rospy.init_node("stream_rate", disable_rostime=True)
    master, clock = rosgraph.Master("/stream_rate"), WorldClock()
    time.sleep(1.0)  # until connections are made
    alone = clock.factor(given.seconds)
    pid = xmlrpc.client.ServerProxy(master.lookupNode(NODE)).getPid("/stream_rate")[2]
    link = PageLink(master.getParam(f"{NODE}/url"))
    if given.poses:
        link.ask("watch", what="poses")
    answer = link.ask("watch", what="image", args={"topic": given.topic})
    if not answer["ok"]:
        raise SystemExit(answer["error"])
    time.sleep(1.0)
    link.events.clear()
    began, before = time.monotonic(), processor_seconds(pid)
    watched = clock.factor(given.seconds)
    took, spent = time.monotonic() - began, processor_seconds(pid) - before
    pictures = [event for event in link.events
                if isinstance(event, bytes) and event.startswith(b"\xff\xd8")]
    size = sum(map(len, pictures)) / max(len(pictures), 1) / 1000
    print(f"{len(pictures) / took:.1f} pictures/s of {size:.0f} kB; "
          f"the server takes {100 * spent / took:.0f} % of a core; "
          f"real-time factor {alone:.2f} before, {watched:.2f} meanwhile")
    link.close()


if __name__ == "__main__":
    main()
