"""A node ends by a signal in the middle of a call of its master, which answers only afterwards."""

import os
import signal
import subprocess
import sys
import threading
from socketserver import ThreadingMixIn
from types import SimpleNamespace
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from python_amendments import node_end

LIMIT = 30.0  # s
PROGRAM = """
import threading, rospy
from std_msgs.msg import String
rospy.init_node("held", anonymous=False)
topic = rospy.Publisher("chatter", String, queue_size=1)
rospy.on_shutdown(lambda: print("first"))
rospy.on_shutdown(lambda: print(rospy.get_param("/of_a_hook", "second")))
{}
rospy.spin()
print("ended")
"""
AWAITS = """
import time, rospy, tf2_ros
rospy.rostime.set_rostime_initialized(True)
rospy.core._shutdown_flag = True
begun, now, long = time.monotonic(), rospy.Time(0), rospy.Duration(30.0)
buffer = tf2_ros.Buffer(debug=False)
print(buffer.can_transform("a", "b", now, long),
      buffer.can_transform("a", "b", now, long, True)[0],
      buffer.can_transform_full("a", now, "b", now, "c", timeout=long, return_debug_tuple=True)[0])
try:
    buffer.lookup_transform("a", "b", now, long)
except tf2_ros.LookupException:
    print(time.monotonic() - begun < 10)
"""


class Master(ThreadingMixIn, SimpleXMLRPCServer):
    """It answers a call with that method and name when the node has unregistered."""

    daemon_threads = True

    def __init__(self, method, name):
        super().__init__(("127.0.0.1", 0), logRequests=False)
        self.register_multicall_functions()
        self.register_instance(SimpleNamespace(_dispatch=self.answer))
        self.held, self.kept = (method, name), threading.Event()
        self.publishers, self.gone = set(), threading.Event()

    def answer(self, method, words):
        if method == "unregisterPublisher":
            self.publishers.discard(words[1])
            self.gone.set()
        if method == self.held[0] and self.held[1] in words:
            self.kept.set()
            self.gone.wait(LIMIT)
        if method == "registerPublisher":
            self.publishers.add(words[1])
        return [1, "", []] if method.startswith("register") else [-1, "", 0]


@pytest.fixture
def interrupted():
    """What a node prints, and its master, after a signal in the middle of this statement's call."""
    left = []

    def run(statement, method, name, number):
        master = Master(method, name)
        left.append(master.server_close)
        left.append(master.shutdown)
        threading.Thread(target=master.serve_forever, daemon=True).start()
        node = subprocess.Popen(
            [sys.executable, "-u", "-c", PROGRAM.format(statement)], text=True,
            stdout=subprocess.PIPE, env=os.environ | {
                "ROS_MASTER_URI": f"http://127.0.0.1:{master.server_address[1]}"})
        left.append(node.kill)
        assert master.kept.wait(LIMIT)
        node.send_signal(number)
        lines = node.communicate(timeout=LIMIT / 2)[0].splitlines()
        return lines, master, node.returncode

    yield run
    while left:
        left.pop()()


@pytest.mark.processes
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(("statement", "method", "name"), [
    ("rospy.loginfo('a line')", "subscribeParam", "/rosout_disable_topics_generation"),
    ("rospy.get_param('/a', 0)", "getParam", "/a"),
    ("rospy.Publisher('/a', String, queue_size=1)", "registerPublisher", "/a"),
    ("threading.Thread(target=rospy.get_param, args=('/a', 0)).start()", "getParam", "/a")])
def test_a_node_ends_in_the_middle_of_a_call(interrupted, statement, method, name, number):
    lines, master, _ = interrupted(statement, method, name, number)
    assert [line for line in lines if "a line" not in line] == ["first", "second", "ended"]
    assert master.gone.is_set()
    assert not master.publishers


@pytest.mark.processes
def test_a_closed_terminal_runs_the_hooks_and_ends_the_node(interrupted):
    lines, master, code = interrupted("rospy.get_param('/a', 0)", "getParam", "/a", signal.SIGHUP)
    assert lines == ["first", "second"] and code == -signal.SIGHUP
    assert master.gone.is_set()


@pytest.mark.parametrize("before", [signal.SIG_IGN, lambda *_: None])
def test_a_hangup_that_nohup_or_the_node_handles_stays_theirs(before):
    kept = signal.signal(signal.SIGHUP, before)
    try:
        node_end.registering_hangup(lambda: None, None)()
        assert signal.getsignal(signal.SIGHUP) is before
    finally:
        signal.signal(signal.SIGHUP, kept)


def test_what_a_held_answer_leaves_is_not_the_next_calls():
    did = []

    class Base:
        def __init__(self, _uri):
            self._lock = threading.Lock()

        def _ServerProxy__request(self, *_):
            raise KeyboardInterrupt

        def __call__(self, what):
            return lambda: did.append(what)

    with pytest.raises(KeyboardInterrupt):
        node_end.proxy_without_waiting(Base, lambda: True)("")._ServerProxy__request("getPid", ())
    assert did == ["close"]


@pytest.mark.parametrize(("after", "forced"), [(0.5, False), (2.5, True)])
@pytest.mark.parametrize("hangs", [False, True])
def test_only_a_later_ctrl_c_ends_a_node_by_force(monkeypatch, after, forced, hangs):
    now, handled = [0.0], []
    monkeypatch.setattr(node_end.time, "monotonic", lambda: now[0])

    def again():
        now[0] = after
        at_signal(signal.SIGINT, None)

    def handler(number, _frame):  # as rospy's, which drops what is raised in its hooks
        handled.append(number)
        if hangs and len(handled) == 1:
            try:
                again()
            except KeyboardInterrupt:
                handled.append("hook left")

    at_signal = node_end.handler_with_force(handler)

    def press_twice():
        at_signal(signal.SIGINT, None)
        if not hangs:
            again()

    if forced:
        with pytest.raises(KeyboardInterrupt):
            press_twice()
    else:
        press_twice()
    assert handled == [signal.SIGINT] + ([signal.SIGINT] if not forced else
                                         ["hook left"] if hangs else [])


def test_a_hook_may_publish_in_the_middle_of_a_publish():
    from rospy.impl import registration, tcpros_pubsub

    for lock in (tcpros_pubsub.threading.Lock(), registration.get_registration_listeners().lock):
        with lock:
            assert lock.acquire(blocking=False)
            lock.release()


def test_no_frame_is_awaited_after_the_nodes_end():
    # by demo04_sub.py for 3 s
    done = subprocess.run([sys.executable, "-c", AWAITS], capture_output=True, text=True,
                          timeout=LIMIT)
    assert (done.stdout, done.stderr) == ("False False False\nTrue\n", "")
