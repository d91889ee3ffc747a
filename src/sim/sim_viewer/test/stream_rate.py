#!/usr/bin/env python3
"""Counts the images that clients of a page get, and what they cost server and world: no test.

    python3 src/sim/sim_viewer/test/stream_rate.py [--topic /camera/rgb/image_raw] [--seconds 10]
        [--poses] [--clients 40] [--hostile] [--drive cmd_vel]

The page must run; its address comes from the parameter /sim_viewer/url. With --drive, which needs
a page with control, a driver's connection is cut meanwhile: the time until the robot is told to
stop is printed.
"""

import argparse
import os
import threading
import time
import xmlrpc.client
from pathlib import Path

import aiohttp
import rosgraph
import rospy
from background import wait_until
from geometry_msgs.msg import Twist
from page_link import PageLink
from rosgraph_msgs.msg import Clock

NODE = "/sim_viewer"
TICK = os.sysconf("SC_CLK_TCK")
PRESS = 0.1  # s between two messages of a held key
STOPS = 5  # of a driver, of which the slowest is printed


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


class Driver:
    """Drives by the page, and hears what the robot is told."""

    def __init__(self, url: str, topic: str) -> None:
        self._url, self._topic = url, topic
        self._heard: list[tuple[float, float]] = []  # s, monotonic; m/s
        rospy.Subscriber(topic, Twist, lambda told: self._heard.append(
            (time.monotonic(), told.linear.x)))

    def stop_time(self) -> float:
        """s from when a driver's connection is cut to the stop."""
        link = PageLink(self._url)
        for _ in range(10):
            answer = link.ask("drive", linear=0.1, angular=0.0, topic=self._topic)
            if not answer["ok"]:
                raise SystemExit(answer["error"])
            time.sleep(PRESS)
        wait_until(lambda: self._heard and self._heard[-1][1], "a command")
        cut = time.monotonic()
        link.abort()
        return wait_until(lambda: [at for at, speed in self._heard if at > cut and not speed],
                          "the stop")[0] - cut


def watching(url: str, topic: str, poses: bool) -> PageLink:
    """A client that looks at a camera, and with `poses` at the 3D view too."""
    link = PageLink(url)
    if poses:
        link.ask("watch", what="poses")
    answer = link.ask("watch", what="image", args={"topic": topic})
    if not answer["ok"]:
        raise SystemExit(answer["error"])
    return link


def hostile(url: str, topic: str, ended: threading.Event) -> None:
    """One client that never reads, and one that floods the page with requests until it is cut."""
    slow = watching(url, topic, True)
    slow.pause()
    while not ended.is_set():
        try:
            flood = PageLink(url)
            while not ended.is_set():
                flood.send("watch", what="image", args={"topic": topic})
        except (aiohttp.ClientError, ConnectionError, TimeoutError):  # cut off, as it should be
            time.sleep(0.1)


def summary(received: list[list[dict | bytes]], took: float) -> str:
    """What clients got in `took` seconds, from the slowest to the fastest; none is a figure too."""
    images = [[event for event in events if isinstance(event, bytes)
               and event.startswith(b"\xff\xd8")] for events in received]
    rates = [len(each) / took for each in images]
    sizes = [len(image) for each in images for image in each]
    size = sum(sizes) / max(len(sizes), 1) / 1000
    return f"{min(rates):.1f} to {max(rates):.1f} images/s of {size:.0f} kB each"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--topic", default="/camera/rgb/image_raw")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--poses", action="store_true", help="watch the 3D view's poses too")
    parser.add_argument("--clients", type=int, default=1)
    parser.add_argument("--hostile", action="store_true", help="beside them a client that does not "
                        "read and one that floods")
    parser.add_argument("--drive", metavar="TOPIC", default="")
    given = parser.parse_args()
    if given.clients < 1:
        parser.error("--clients: at least 1")
    rospy.init_node("stream_rate", disable_rostime=True)
    master, clock = rosgraph.Master("/stream_rate"), WorldClock()
    time.sleep(1.0)  # until connections are made
    alone = clock.factor(given.seconds)
    pid = xmlrpc.client.ServerProxy(master.lookupNode(NODE)).getPid("/stream_rate")[2]
    url, ended = master.getParam(f"{NODE}/url"), threading.Event()
    links = [watching(url, given.topic, given.poses) for _ in range(given.clients)]
    if given.hostile:
        threading.Thread(target=hostile, args=(url, given.topic, ended), daemon=True).start()
    time.sleep(1.0)
    for link in links:
        link.events.clear()
    began, before = time.monotonic(), processor_seconds(pid)
    watched = clock.factor(given.seconds)
    took, spent = time.monotonic() - began, processor_seconds(pid) - before
    print(f"{summary([link.events for link in links], took)}; "
          f"the server takes {100 * spent / took:.0f} % of a core; "
          f"real-time factor {alone:.2f} before, {watched:.2f} meanwhile")
    if given.drive:
        driver = Driver(url, given.drive)
        stops = [driver.stop_time() for _ in range(STOPS)]
        print(f"a driver whose connection is cut: the robot is told to stop after "
              f"{max(stops):.3f} s at most ({STOPS} times)")
    ended.set()
    for link in links:
        link.close()


if __name__ == "__main__":
    main()
