"""The simulated clock: while it does not run, one line is logged about that, and no other."""

from __future__ import annotations

import threading
import time

import rospy
from rosgraph_msgs.msg import Clock

from nav_nodes.missing_data import MissingData
from nav_nodes.topic_watchdog import is_published

CLOCK = "simulated clock /clock"
LOOK = 0.25   # s of wall time between two checks
STILL = 1.0   # s of wall time without a tick until its publishers are checked


def watch(missing_data: MissingData) -> None:
    """Start a watching thread, if /use_sim_time is true. A paused simulation is not a fault."""
    if not rospy.rostime.is_wallclock():
        threading.Thread(target=_watch, args=(missing_data,), daemon=True).start()


def wait_until_it_runs(missing_data: MissingData) -> bool:
    """Wait until time is not 0, which no message's stamp may be; False at shutdown."""
    watch(missing_data)
    while rospy.Time.now().is_zero() and not rospy.is_shutdown():
        time.sleep(LOOK / 5)
    return not rospy.is_shutdown()


def _watch(missing_data: MissingData) -> None:
    before, changed = rospy.Time.now(), time.monotonic()
    ticks = rospy.Subscriber("/clock", Clock, queue_size=1)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        if now != before:
            before, changed = now, time.monotonic()
        stands = time.monotonic() - changed > STILL and not is_published(ticks)
        if now.is_zero() or stands:
            missing_data.missing(CLOCK, _why(ticks), since=changed, is_root=True)
        else:
            missing_data.present(CLOCK)
        time.sleep(LOOK)


def _why(ticks: rospy.Subscriber) -> str:
    advice = ("its publisher is silent, is the simulation paused?" if is_published(ticks)
              else "nobody publishes it; start the simulator.")
    return f"{advice} Or rosparam set use_sim_time false and start again"
