"""Small ROS nodes that write down what they see, for the part that reads it.

    python3 -m sim_bench.probes follower OUT LESSON
    python3 -m sim_bench.probes listener OUT TOPIC...
    python3 -m sim_bench.probes clock OUT PERIOD_NS
    python3 -m sim_bench.probes first_image OUT TOPIC

Columns of numbers; WALL is CLOCK_MONOTONIC in s, which all processes share.
"""

from __future__ import annotations

import runpy
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import rosgraph
import rospy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image

WRITE_PERIOD = 1.0  # s, wall
POLL = 0.01  # s, wall
FRAME, CLOCK = 0, 1


def follower(out: Path, lesson: str) -> None:
    """Runs a lesson as it is, in this process, and writes down when its callback got which frame.

    rospy.Subscriber is replaced before by one that notes each image's arrival at the callback, and
    /clock too, over the connection that rospy has open anyway. Lines are `0 WALL STAMP WIDTH
    CALLBACK` for images and `1 WALL TIME 0 0` for /clock, in s and px.
    """
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


class TopicCount:
    """Hears a topic, unread: how many messages have come."""

    def __init__(self, topic: str):
        self._messages = 0
        rospy.Subscriber(topic, rospy.AnyMsg, self._add, queue_size=1)

    def _add(self, _message: rospy.AnyMsg) -> None:
        self._messages += 1

    def line(self) -> str:
        """`MESSAGES`."""
        return f"{self._messages}\n"


class ClockStatistics:
    """Whether /clock's times are whole periods, and how far it has come."""

    def __init__(self, period_ns: int):
        self._period_ns = period_ns
        self._messages = self._last_ns = self._worst_off_ns = 0

    def add(self, time_ns: int) -> None:
        """One message."""
        off = time_ns % self._period_ns
        self._messages += 1
        self._last_ns = time_ns
        self._worst_off_ns = max(self._worst_off_ns, min(off, self._period_ns - off))

    def line(self) -> str:
        """`MESSAGES LAST_NS WORST_OFF_NS`: the worst distance of a time from a whole period."""
        return f"{self._messages} {self._last_ns} {self._worst_off_ns}\n"


def listener(out: Path, *topics: str) -> None:
    """Rewrites OUT once a wall second, with a line for each topic."""
    rospy.init_node("listener", disable_rostime=True)
    _rewrite(out, [TopicCount(topic) for topic in topics])


def clock(out: Path, period_ns: str) -> None:
    """Rewrites OUT once a wall second, with what /clock has published so far."""
    rospy.init_node("clock_watch", disable_rostime=True)
    statistics = ClockStatistics(int(period_ns))
    rospy.Subscriber("/clock", Clock, lambda message: statistics.add(message.clock.to_nsec()))
    _rewrite(out, [statistics])


def first_image(out: Path, topic: str) -> None:
    """A line `WALL` each when it begins to wait, when the master answers, when an image is here."""
    there = threading.Event()
    with out.open("w", encoding="ascii", buffering=1) as file:

        def note() -> None:
            file.write(f"{time.monotonic():.6f}\n")

        def got(_image: Image) -> None:
            if not there.is_set():
                note()
                there.set()

        note()
        while not rosgraph.is_master_online():
            time.sleep(POLL)
        note()
        rospy.init_node("first_image", disable_rostime=True)
        rospy.Subscriber(topic, Image, got, queue_size=1, buff_size=2**24)
        while not there.wait(POLL) and not rospy.is_shutdown():
            pass


def _rewrite(out: Path, seen: list[TopicCount] | list[ClockStatistics]) -> None:
    """Until it is ended; the file is whole, whenever it is read."""
    while not rospy.is_shutdown():
        rospy.rostime.wallsleep(WRITE_PERIOD)
        fresh = out.with_suffix(".new")
        fresh.write_text("".join(each.line() for each in seen), encoding="ascii")
        fresh.replace(out)


if __name__ == "__main__":
    _, kind, path, *rest = rospy.myargv()
    {"follower": follower, "listener": listener, "clock": clock,
     "first_image": first_image}[kind](Path(path), *rest)
