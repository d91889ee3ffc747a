"""Small ROS nodes that write down what they see, for the part that reads it.

    python3 -m sim_bench.probes follower OUT LESSON
    python3 -m sim_bench.probes listener OUT TOPIC...
    python3 -m sim_bench.probes clock OUT
    python3 -m sim_bench.probes first_image OUT TOPIC

Columns of numbers; WALL is CLOCK_MONOTONIC in s, which all processes share.
"""

from __future__ import annotations

import runpy
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

import rosgraph
import rospy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image

POLL = 0.01  # s, wall
FRAME, CLOCK = 0, 1


def follower(out: Path, lesson: str) -> None:
    """Runs a lesson as it is, in this process, and writes down when its callback got which frame.

    rospy.Subscriber is replaced before by one that notes each image's arrival at the callback, and
    /clock too, over the connection that rospy has open anyway. Lines are `0 WALL STAMP WIDTH
    CALLBACK` for images and `1 WALL TIME 0 0` for /clock, in s and px.
    """
    plain = rospy.Subscriber
    file = _lines(out)

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


def listener(out: Path, *topics: str) -> None:
    """Hears topics, unread: a line with the topic's place among them for each message."""
    rospy.init_node("listener", disable_rostime=True)
    file = _lines(out)
    for place, topic in enumerate(topics):
        rospy.Subscriber(topic, rospy.AnyMsg, lambda _message, line=f"{place}\n": file.write(line),
                         queue_size=1)
    rospy.spin()


def clock(out: Path) -> None:
    """A line `TIME_NS` for each message of /clock."""
    rospy.init_node("clock_watch", disable_rostime=True)
    file = _lines(out)
    rospy.Subscriber("/clock", Clock, lambda message: file.write(f"{message.clock.to_nsec()}\n"))
    rospy.spin()


def first_image(out: Path, topic: str) -> None:
    """A line `WALL` when it begins to wait for the master, and one when an image is here."""
    file = _lines(out)
    file.write(f"{time.monotonic():.6f}\n")
    while not rosgraph.is_master_online():
        time.sleep(POLL)
    rospy.init_node("first_image", disable_rostime=True)
    rospy.wait_for_message(topic, Image)
    file.write(f"{time.monotonic():.6f}\n")
    rospy.spin()


def _lines(out: Path) -> TextIO:
    """The file, of which every line is there as soon as it is written."""
    return out.open("w", encoding="ascii", buffering=1)


if __name__ == "__main__":
    _, kind, path, *rest = rospy.myargv()
    {"follower": follower, "listener": listener, "clock": clock,
     "first_image": first_image}[kind](Path(path), *rest)
