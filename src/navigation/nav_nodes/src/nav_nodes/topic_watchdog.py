"""Who notices that a topic is silent, /clock among them, and why it may be.

While the simulated clock does not run, one line is logged about that, and no other.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import rospy
from rosgraph_msgs.msg import Clock

from nav_nodes.missing_data import MissingData

QUIET = 1.0  # s of wall time without a message until it is reported
CLOCK = "simulated clock /clock"
LOOK = 0.25   # s of wall time between two checks
STILL = 1.0   # s of wall time without a tick until its publishers are checked


def is_published(topic: rospy.Subscriber) -> bool:
    """Whether a publisher is connected.

    rospy's own count includes killed publishers, which it tries to reconnect to for ever.
    """
    impl = topic.impl
    return impl is not None and any(link.socket is not None for link in impl.connections)


def why_silent(topic: rospy.Subscriber, name: str) -> str:
    """Advice for a topic whose name in the node, before remapping, is `name` ("scan")."""
    if is_published(topic):
        return "its publisher is silent, is the simulation paused?"
    return (f"nobody publishes there {topic.data_class._type} (rostopic info "
            f"{topic.resolved_name}, or {name}:=TOPIC)")


class TopicWatchdog:
    """Notices that a topic is silent, except while a message from it is being processed."""

    def __init__(self, missing_data: MissingData, what: str, name: str) -> None:
        """`what`: the topic's content ("laser scans"); `name`: its name in the node ("scan")."""
        self._missing_data, self._what, self._name = missing_data, what, name
        self._last, self._at_work = time.monotonic(), False

    @contextmanager
    def heard(self) -> Iterator[None]:
        """A context for the processing of a message."""
        self._at_work = True
        try:
            yield
        finally:
            self._last, self._at_work = time.monotonic(), False

    def look(self, topic: rospy.Subscriber) -> None:
        """Call periodically: logs how long it has been silent."""
        what = f"{self._what} on {topic.resolved_name}"
        if not self._at_work and time.monotonic() - self._last > QUIET:
            self._missing_data.missing(what, why_silent(topic, self._name), since=self._last)
        else:
            self._missing_data.present(what)


def watch_clock(missing_data: MissingData) -> None:
    """Start a watching thread, if /use_sim_time is true. A paused simulation is not a fault."""
    if not rospy.rostime.is_wallclock():
        threading.Thread(target=_watch_clock, args=(missing_data,), daemon=True).start()


def wait_for_clock(missing_data: MissingData) -> bool:
    """Wait until time is not 0, which no message's stamp may be; False at shutdown."""
    watch_clock(missing_data)
    while rospy.Time.now().is_zero() and not rospy.is_shutdown():
        time.sleep(LOOK / 5)
    return not rospy.is_shutdown()


def _watch_clock(missing_data: MissingData) -> None:
    before, changed = rospy.Time.now(), time.monotonic()
    ticks = rospy.Subscriber("/clock", Clock, queue_size=1)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        if now != before:
            before, changed = now, time.monotonic()
        stands = time.monotonic() - changed > STILL and not is_published(ticks)
        if now.is_zero() or stands:
            missing_data.missing(CLOCK, _why_clock_stands(ticks), since=changed, is_root=True)
        else:
            missing_data.present(CLOCK)
        time.sleep(LOOK)


def _why_clock_stands(ticks: rospy.Subscriber) -> str:
    advice = ("its publisher is silent, is the simulation paused?" if is_published(ticks)
              else "nobody publishes it; start the simulator.")
    return f"{advice} Or rosparam set use_sim_time false and start again"
