"""How the node ends, without a master: rospy's flags and hooks are this test's own."""

import os
import signal
import threading
import time

import pytest
import rospy
from rospy import core

from bullet_sim_ros import shutdown


@pytest.fixture(autouse=True)
def own_rospy(monkeypatch):
    for hooks in ("_client_shutdown_hooks", "_preshutdown_hooks", "_shutdown_hooks"):
        monkeypatch.setattr(core, hooks, [])
    for flag in ("_shutdown_flag", "_in_shutdown"):
        monkeypatch.setattr(core, flag, False)


def test_no_topic_is_closed_while_the_loop_still_publishes():
    """Chaos: race, seed 203, ends it by rosnode kill; rospy closes topics in its preshutdown."""
    closed, asked = threading.Event(), threading.Event()
    core._preshutdown_hooks += [lambda _: time.sleep(0.2), lambda _: closed.set()]
    ended = shutdown.end_before_topics(asked.set)
    master = threading.Thread(target=rospy.signal_shutdown, args=("user request",))
    master.start()
    assert asked.wait(10.0) and not closed.wait(0.5)
    ended.set()
    shutdown.shut_down()  # the main thread's
    assert closed.is_set() and rospy.is_shutdown()
    master.join(10.0)


def test_a_loop_that_begins_after_the_shutdown_is_not_waited_for(monkeypatch):
    monkeypatch.setattr(core, "_shutdown_flag", True)
    began = time.monotonic()
    shutdown.end_before_topics(lambda: None)
    assert time.monotonic() - began < shutdown.LOOP_END / 2


def test_a_signal_ends_what_waits_for_a_master_that_is_gone(monkeypatch):
    """rospy's registration waits until ROS shuts down, whatever becomes of the loop."""
    monkeypatch.setattr(shutdown, "LOOP_END", 0.1)
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    asked = threading.Event()
    try:
        shutdown.end_by_signals(asked.set)
        os.kill(os.getpid(), signal.SIGTERM)
        until = time.monotonic() + 10.0
        while not rospy.is_shutdown() and time.monotonic() < until:
            time.sleep(0.01)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    assert asked.is_set() and rospy.is_shutdown()
