"""Shutdown of the node: by a signal, by the master, by itself."""

import signal
import threading
import time
from collections.abc import Callable

import rospy
from node_basics.ending import at_signals

from bullet_sim_ros.rospy_patches import report_shutdown

LOOP_END = 2.0  # s, wall, that a shutdown from outside waits at most for the loop
SHUTDOWN_LIMIT = 2.0  # s, wall; a master that hangs answers nobody


def end_by_signals(stop: Callable[[], None]) -> None:
    """Make Ctrl-C and SIGTERM end the loop. If that has not begun, rospy may be waiting for a
    master that is gone, which only a shutdown ends; so that follows after LOOP_END."""
    at_signals(stop, LOOP_END, lambda _: shut_down(), (signal.SIGINT, signal.SIGTERM))


def end_before_topics(stop: Callable[[], None]) -> threading.Event:
    """Make a shutdown from outside (`rosnode kill`) wait for the returned event,
    the loop's end, before it closes topics: rospy reports a shutdown only afterwards, and until
    then publishing raises an exception."""
    ended = threading.Event()

    def wait_for_the_end() -> None:
        stop()
        ended.wait(LOOP_END)

    if not rospy.is_shutdown():  # it would be called at once
        rospy.on_shutdown(wait_for_the_end)
    return ended


def shut_down() -> None:
    """Shut rospy down; returns once that is done, by whichever thread, or after SHUTDOWN_LIMIT.

    rospy unregisters at the master before it reports the shutdown, and for that needs the lock of
    its list of services; a thread that keeps trying to register a service holds that lock.
    """
    own = threading.Thread(
        target=rospy.signal_shutdown, args=("the simulation has ended",), daemon=True)
    until = time.monotonic() + SHUTDOWN_LIMIT
    own.start()
    own.join(SHUTDOWN_LIMIT)
    while not rospy.is_shutdown() and time.monotonic() < until:
        time.sleep(0.01)
    report_shutdown()
