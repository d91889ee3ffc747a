"""A node that changes something for as long as it lives, and changes it back at its end."""

import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType

import rospy
from node_basics.ending import drop_unread_output

POLL_PERIOD = 0.1  # s
UNDO_LIMIT = 10.0  # s of wall time; roslaunch kills what has not ended after 15


def bounded(undo: Callable[[], None]) -> None:
    """Runs `undo`, but does not stay with a manager that answers nothing.

    A manager works on one request at a time, so in a paused world all of them wait behind a switch.
    """
    drop_unread_output()
    thread = threading.Thread(target=undo, daemon=True)
    thread.start()
    thread.join(UNDO_LIMIT)
    if thread.is_alive():
        rospy.logwarn(f"The controller manager has not answered for {UNDO_LIMIT:.0f} s, is the "
                      "world paused? Ended without it")


def live(name: str, work: Callable[[], int | None], undo: Callable[[], None]) -> int:
    """Runs `work` and, at a signal or when the master ends the node, `undo`; the exit code.

    `work` returns None to stay until then, or the exit code to end with, without `undo`. A signal
    interrupts a call that waits for its answer (a switch in a paused world never comes to one);
    rospy's handler would not, and would call services on top of the line it interrupted.
    A library may swallow the interruption (rospy's logging does): then the signal still counts.
    """
    stop_requested = threading.Event()

    def end(_number: int, _frame: FrameType | None) -> None:
        stop_requested.set()
        raise KeyboardInterrupt

    sys.stdout.reconfigure(line_buffering=True)  # into a file or pipe, too: who waits there sees it
    for number in (signal.SIGINT, signal.SIGTERM):  # a shell's background job ignores the first
        signal.signal(number, end)
    try:
        rospy.init_node(name, anonymous=True, disable_signals=True)
        rospy.on_shutdown(lambda: bounded(undo))
        code = work()
        if code is not None:
            return code
        while not rospy.is_shutdown() and not stop_requested.is_set():
            rospy.rostime.wallsleep(POLL_PERIOD)
    except (KeyboardInterrupt, rospy.ROSInterruptException):
        pass
    for number in (signal.SIGINT, signal.SIGTERM):  # a second one ends it at once
        signal.signal(number, signal.SIG_DFL)
    rospy.signal_shutdown("terminated")
    return 0
