"""Who is silent, and for how long: one line for all that is missing, at most every 5 s.

While the simulated clock does not run, one line is logged about that, and no other, by one of the
nodes of a launch file.
"""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import rospy
from rosgraph_msgs.msg import Clock

INTERVAL = 5.0    # s of wall time between two lines about the same absence
GATHERING = 0.3   # s that a first line waits for others that are missing for the same reason
SOON = 3.0        # s, at most, between a root cause and its result
RECENT = 2.0      # s since the last report, within which an absence is logged
FORGOTTEN = 12.0  # s without reports, after which a report begins a new absence
QUIET = 1.0  # s of wall time without a message until it is reported
CLOCK = "simulated clock /clock"
LOOK = 0.25   # s of wall time between two checks
STILL = 1.0   # s of wall time without a tick until its publishers are checked


@dataclass
class _Absence:
    since: float
    patience: float
    advice: str
    is_root: bool
    is_result: bool
    seen: float
    said: float | None = None


class Speaker:
    """Lets one of the nodes that a roslaunch, or a terminal, has started speak for all of them."""

    def __init__(self) -> None:
        self._held: socket.socket | None = None

    def is_this(self) -> bool:
        """Whether this node is it: the first that asks, until its process ends."""
        if self._held is None:
            name = socket.socket(socket.AF_UNIX)  # names of this kind end with their process
            try:
                name.bind(f"\0nav_nodes/{os.stat('/proc/self/ns/pid').st_ino}/{os.getppid()}")
            except OSError:
                name.close()
                return False
            self._held = name
        return True


class MissingData:
    """Records since when each item has been missing. One per node; thread-safe.

    Uses wall time, because a running simulated clock is one of the items that can be missing.
    """

    def __init__(self, patience: float = 1.0) -> None:
        """Nothing is logged in the first `patience` s of an absence."""
        self._patience, self._speaker = patience, Speaker()
        self._lock = threading.Lock()
        self._absent: dict[str, _Absence] = {}

    def missing(self, what: str, advice: str = "", patience: float | None = None,
                since: float | None = None, is_root: bool = False,
                is_result: bool = False) -> None:
        """Report that `what` ("laser scans on /scan") is still missing; call whenever noticed.

        If several callers miss it, the `advice` of the one with the least patience is logged.
        `since` (time.monotonic): set if earlier than the first call. While an item with `is_root`
        is missing, nothing else is logged: it follows from that. An item with `is_result` is not
        logged while another has been missing since about then, whatever its patience.
        """
        now = time.monotonic()
        patience = self._patience if patience is None else patience
        with self._lock:
            entry = self._absent.get(what)
            if entry is None or now - entry.seen > FORGOTTEN:
                entry = self._absent[what] = _Absence(now, patience, advice, is_root, is_result,
                                                      now)
            entry.since, entry.seen = min(entry.since, now if since is None else since), now
            if patience <= entry.patience:
                entry.patience, entry.advice = patience, advice
            line = self._line(now)
        if line:
            rospy.logwarn("%s", line)

    def present(self, what: str) -> None:
        """Report that `what` is there, which ends its absence."""
        with self._lock:
            entry = self._absent.pop(what, None)
        if entry is not None and entry.said is not None and self._says(entry):
            rospy.loginfo("%s: there again", what)

    def _line(self, now: float) -> str:
        """The line to log now, or ""; a new absence does not wait for the INTERVAL of others."""
        known = self._known(now)
        new = {what: entry for what, entry in known.items() if entry.said is None}
        if new:
            gathering = all(now - entry.since < entry.patience + GATHERING
                            for entry in new.values())
            due = {} if gathering else new
        else:
            due = known if all(now - entry.said >= INTERVAL for entry in known.values()) else {}
        for entry in due.values():
            entry.said = now
        return "; ".join(f"no {what} for {now - entry.since:.0f} s"
                         + (f": {entry.advice}" if entry.advice else "")
                         for what, entry in due.items() if self._says(entry))

    def _says(self, entry: _Absence) -> bool:
        return not entry.is_root or self._speaker.is_this()

    def _known(self, now: float) -> dict[str, _Absence]:
        """What has been missing for longer than its patience, and follows from nothing else."""
        recent = {what: entry for what, entry in self._absent.items() if now - entry.seen <= RECENT}
        causes = [entry.since for entry in recent.values()
                  if not entry.is_result and now - entry.since >= self._patience]
        known = {what: entry for what, entry in recent.items()
                 if now - entry.since >= entry.patience and not (
                     entry.is_result and any(abs(entry.since - cause) < SOON for cause in causes))}
        return {what: entry for what, entry in known.items() if entry.is_root} or known


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
              else "nobody publishes it; start the simulator in another terminal, for nav_demo "
              "with roslaunch urdf02_gazebo demo02_obstacles.launch, for TurtleBot3 with "
              "roslaunch turtlebot3_gazebo turtlebot3_world.launch; then end this launch file and "
              "type it again.")
    return f"{advice} Without one, set use_sim_time to false where it is set to true"
