"""Ends of the node: by a signal, by the master, by itself."""

import signal
import threading
import time
from collections.abc import Callable

import rospy
from rospy import core

LOOP_END = 2.0  # s, wall, that a shutdown from outside waits at most for the loop
SHUTDOWN_LIMIT = 2.0  # s, wall; a master that hangs answers nobody


def end_by_signals(stop: Callable[[], None]) -> None:
    """Ctrl-C and SIGTERM end the loop. Where it has not begun rospy may wait for a master that is
    gone, and hears of nothing but a shutdown."""
    def end(_number: int, _frame: object) -> None:
        stop()
        last = threading.Timer(LOOP_END, shut_down)
        last.daemon = True
        last.start()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)


def end_before_topics(stop: Callable[[], None]) -> threading.Event:
    """Have a shutdown from outside (`rosnode kill`, a second /gazebo) wait for the event, which is
    the loop's end, before it closes topics: rospy says only afterwards that it shuts down, and what
    is published meanwhile is an exception."""
    ended = threading.Event()

    def wait_for_the_end() -> None:
        stop()
        ended.wait(LOOP_END)

    if not rospy.is_shutdown():  # it would be called at once
        rospy.on_shutdown(wait_for_the_end)
    return ended


def shut_down() -> None:
    """Returns when the master knows, whichever thread tells it, or has not answered for a while.

    rospy tells it before it says that it shuts down, and for a list of services asks for a lock;
    that is held while one is registered, again and again until rospy says so.
    """
    own = threading.Thread(
        target=rospy.signal_shutdown, args=("the simulation has ended",), daemon=True)
    until = time.monotonic() + SHUTDOWN_LIMIT
    own.start()
    own.join(SHUTDOWN_LIMIT)
    while not rospy.is_shutdown() and time.monotonic() < until:
        time.sleep(0.01)
    core._shutdown_flag = True
