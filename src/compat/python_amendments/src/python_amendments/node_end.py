"""A node ends at Ctrl-C, SIGTERM and SIGHUP, wherever they interrupt it; a later Ctrl-C forces it.

rospy ends a node in the signal's handler, in the thread that the signal interrupts: what it waits
for there must not be held by the same thread.
"""

import functools
import os
import signal
import threading
import time
from types import SimpleNamespace

PATIENCE = 2.0  # s, wall: two quick presses of Ctrl-C are one
JOIN_TIME = 1.0  # s, wall, for each thread; it may wait for a lock of the interrupted one
UNDONE_BY = {"registerPublisher": ("unregisterPublisher", 3),  # and which word is the node's URI
             "registerSubscriber": ("unregisterSubscriber", 3),
             "registerService": ("unregisterService", 2)}


def amend_core(core):
    """Amend calls of the master and the signals' handler; `core` is the module rospy.core."""
    core._LockedServerProxy = proxy_without_waiting(core._LockedServerProxy, core.is_shutdown)
    core.register_signals = registering_hangup(core.register_signals, core._ros_signal)
    core._ros_signal = handler_with_force(core._ros_signal)
    core._TIMEOUT_SHUTDOWN_JOIN = JOIN_TIME


def proxy_without_waiting(proxy, is_shutdown):
    """This class of proxies, but a call that comes in the middle of another has its own connection.

    The handler unregisters the node, perhaps in the middle of a call of the master: each line of
    rospy.loginfo is one. With rospy's one connection, and its lock, it waits for itself for ever.
    A registration in whose middle the node ended is undone.
    """
    class Proxy(proxy):
        def __init__(self, uri):
            super().__init__(uri)
            self._uri = uri

        def _ServerProxy__request(self, method, words):
            if self._lock.locked():
                with Proxy(self._uri) as own:
                    return own._ServerProxy__request(method, words)
            try:
                answer = super()._ServerProxy__request(method, words)
            except KeyboardInterrupt:
                self("close")()  # an answer that is still to come is not the next call's
                raise
            if method in UNDONE_BY and is_shutdown():
                undo, uri = UNDONE_BY[method]
                self._ServerProxy__request(undo, (*words[:2], words[uri]))
            return answer

    return Proxy


def handler_with_force(handler):
    """This handler of signals, but a later Ctrl-C raises KeyboardInterrupt; rospy's has no effect.

    For a node whose loop does not look at is_shutdown(), whose hooks hang, or whose master does.
    """
    begun, forced = [], []

    def at_signal(number, frame):
        begun.append(time.monotonic())
        if number == signal.SIGINT and begun[-1] - begun[0] > PATIENCE:
            forced.append(True)
        else:
            handler(number, frame)  # it drops what a later one raises in it
        if forced:
            raise KeyboardInterrupt

    return at_signal


def registering_hangup(register, handler):
    """This function of no arguments, but a closed terminal (SIGHUP) also runs a node's hooks.

    rospy knows SIGHUP not: the node would be gone at once, its robot drive on by the last command,
    and its name stay with the master. The process ends by the signal, as without a handler.
    """
    def at_hangup(number, frame):
        handler(number, frame)
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    def register_signals():
        register()
        if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:  # else nohup, or the node's own
            signal.signal(signal.SIGHUP, at_hangup)

    return register_signals


def amend_registration(registration):
    """Let a hook unregister while a topic is registered; the module rospy.impl.registration."""
    registration._registration_listeners.lock = threading.RLock()


def amend_publishing(tcpros_pubsub):
    """Let a hook stop the robot in the middle of a publish(); rospy.impl.tcpros_pubsub."""
    tcpros_pubsub.threading = SimpleNamespace(**vars(threading) | {"Lock": threading.RLock})


class _Ended(Exception):
    """The node has ended in the middle of a sleep."""


def amend_lookups(buffers):
    """Let a frame be awaited no longer than the node runs; the module tf2_ros.buffer.

    Where no simulator publishes a time, rospy's sleep goes on after the node's end.
    """
    rospy = buffers.rospy

    def sleep(duration):
        if rospy.is_shutdown():
            raise _Ended
        rospy.sleep(duration)

    def ending(look):
        @functools.wraps(look)
        def can_transform(buffer, *words, **options):
            try:
                return look(buffer, *words, **options)
            except _Ended:
                debug = options.get("return_debug_tuple", words and words[-1] is True)
                return (False, "the node has ended") if debug else False

        return can_transform

    buffers.rospy = SimpleNamespace(**vars(rospy) | {"sleep": sleep})
    for name in ("can_transform", "can_transform_full"):
        setattr(buffers.Buffer, name, ending(getattr(buffers.Buffer, name)))
