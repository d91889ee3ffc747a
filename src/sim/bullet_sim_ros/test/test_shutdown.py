"""How the node ends, without a master: rospy's flags and hooks are this test's own."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest
import rospy
from rospy import core

from bullet_sim_ros import shutdown

LIMIT = 60.0  # s
SLOW_MODULE = """
import time
print("loads", flush=True)
try:
    time.sleep(60)
except KeyboardInterrupt:
    raise ImportError("as NumPy says it")
"""


@pytest.fixture(autouse=True)
def own_rospy(monkeypatch):
    before = set(threading.enumerate())
    for hooks in ("_client_shutdown_hooks", "_preshutdown_hooks", "_shutdown_hooks"):
        monkeypatch.setattr(core, hooks, [])
    for flag in ("_shutdown_flag", "_in_shutdown"):
        monkeypatch.setattr(core, flag, False)
    yield
    for thread in set(threading.enumerate()) - before:  # it may be about to set a flag
        thread.join(LIMIT)


def test_no_topic_is_closed_while_the_loop_still_publishes(monkeypatch):
    """Chaos: race, seed 203, ends it by rosnode kill; rospy closes topics in its preshutdown."""
    monkeypatch.setattr(shutdown, "LOOP_END", LIMIT)
    monkeypatch.setattr(shutdown, "SHUTDOWN_LIMIT", LIMIT)
    closed, asked = threading.Event(), threading.Event()
    core._preshutdown_hooks += [lambda _: time.sleep(0.2), lambda _: closed.set()]
    ended = shutdown.end_before_topics(asked.set)
    master = threading.Thread(target=rospy.signal_shutdown, args=("user request",))
    master.start()
    assert asked.wait(LIMIT) and not closed.wait(0.5)
    ended.set()
    shutdown.shut_down()  # the main thread's
    assert closed.is_set() and rospy.is_shutdown()
    master.join(LIMIT)


def test_a_loop_that_begins_after_the_shutdown_is_not_waited_for(monkeypatch):
    monkeypatch.setattr(core, "_shutdown_flag", True)
    monkeypatch.setattr(shutdown, "LOOP_END", LIMIT)
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
        until = time.monotonic() + LIMIT
        while not rospy.is_shutdown() and time.monotonic() < until:
            time.sleep(0.01)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    assert asked.is_set() and rospy.is_shutdown()


def test_a_service_that_registers_with_a_master_that_is_gone_ends(monkeypatch):
    """rospy holds the services' lock until ROS shuts down, and asks for it before."""
    monkeypatch.setattr(shutdown, "SHUTDOWN_LIMIT", 0.1)
    services, registers, over = threading.Lock(), threading.Event(), threading.Event()

    def register():
        with services:
            registers.set()
            while not (rospy.is_shutdown() or over.wait(0.01)):
                pass

    registering = threading.Thread(target=register)
    registering.start()
    assert registers.wait(LIMIT)
    core._preshutdown_hooks.append(lambda _: services.acquire())
    ends = threading.Thread(target=shutdown.shut_down)
    ends.start()
    try:
        ends.join(LIMIT)
        registering.join(LIMIT)
        assert not (ends.is_alive() or registering.is_alive())
    finally:
        over.set()


def test_ctrl_c_while_modules_load_is_no_traceback(tmp_path):
    (tmp_path / "rospy.py").write_text(SLOW_MODULE)
    node = subprocess.Popen(
        [sys.executable, "-P", "-m", "bullet_sim_ros"], stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        env=os.environ | {"PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"})
    try:
        assert node.stdout.readline() == "loads\n"
        node.send_signal(signal.SIGINT)
        said, _ = node.communicate(timeout=LIMIT)
    finally:
        node.kill()
    assert (said, node.returncode) == ("", -signal.SIGINT)
