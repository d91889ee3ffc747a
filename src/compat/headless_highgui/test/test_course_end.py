"""A node whose simulator has ended says so once; the connections are this test's own."""

import os
import socket
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest
import rosgraph
import rospy
from headless_highgui import course_end

LIMIT = 60.0  # s
IMAGE, TOPIC = "sensor_msgs/Image", "/camera/rgb/image_raw"


def address(server):
    return f"http://127.0.0.1:{server.getsockname()[1]}/"


@pytest.fixture
def gone():
    """A URI where nobody listens any more."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        uri = address(server)
    return uri


@pytest.fixture
def said(monkeypatch):
    """What the node logs."""
    lines = []
    monkeypatch.setattr(rospy, "logwarn", lambda form, *values: lines.append(form % values))
    monkeypatch.setattr(rospy, "is_shutdown", lambda: False)
    return lines


@pytest.fixture
def asked(monkeypatch):
    """Closes a connection of a subscriber; what was looked into then: topics and publishers."""
    found = []
    monkeypatch.delitem(sys.modules, course_end.WATCHES_ITSELF, raising=False)  # of other tests
    monkeypatch.setattr(course_end, "GRACE", 0.0)
    monkeypatch.setattr(course_end, "tell", lambda *what: found.append(what))

    class Subscriber:
        def __init__(self, kind, closed):
            self.type, self.closed, self.resolved_name = kind, closed, TOPIC

        def remove_connection(self, connection):
            connection.removed = True

    course_end.amend_topics(SimpleNamespace(_SubscriberImpl=Subscriber))

    def close(kind=IMAGE, publisher="/gazebo", uri="http://a:1/", closed=False):
        connection = SimpleNamespace(callerid_pub=publisher, endpoint_id=uri, removed=False)
        Subscriber(kind, closed).remove_connection(connection)
        assert connection.removed
        for thread in threading.enumerate():
            if isinstance(thread, threading.Timer):
                thread.join(LIMIT)
        return found

    return close


def test_a_program_that_watches_its_topics_itself_says_no_more(asked, monkeypatch):
    monkeypatch.setitem(sys.modules, course_end.WATCHES_ITSELF, SimpleNamespace())
    assert asked() == []


def test_once_for_each_simulator(asked):
    asked()
    asked(kind="sensor_msgs/LaserScan")
    assert asked(publisher="/two/gazebo", uri="http://a:2/") == [
        (TOPIC, "http://a:1/"), (TOPIC, "http://a:2/")]


@pytest.mark.parametrize("other", [
    {"closed": True}, {"publisher": "/camera_driver"}, {"kind": "rosgraph_msgs/Clock"}])
def test_other_ends_are_not_the_simulators(asked, other):
    assert asked(**other) == []


def test_a_simulator_that_runs_on_has_not_ended(said):
    with socket.create_server(("127.0.0.1", 0)) as running:  # a model was deleted
        course_end.tell(TOPIC, address(running))
    assert said == []


def test_a_node_that_ends_too_says_nothing(said, gone, monkeypatch):
    monkeypatch.setattr(rospy, "is_shutdown", lambda: True)
    course_end.tell(TOPIC, gone)
    assert said == []


def test_what_to_do_depends_on_the_master(said, gone, monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as master:
        uri = address(master)
        monkeypatch.setattr(rosgraph, "get_master_uri", lambda: uri)
        course_end.tell(TOPIC, gone)
    course_end.tell(TOPIC, gone)
    assert said == [
        f"The simulator has ended: no more messages on {TOPIC}. When the course is started again, "
        "this program goes on by itself.",
        f"The simulator and the ROS master have ended: no more messages on {TOPIC}. Press Ctrl-C; "
        "start the course, then this program again."]


def test_every_python_node_has_it():
    source = str(Path(course_end.__file__).parents[1])
    done = subprocess.run(
        [sys.executable, "-c", "import rospy; print(rospy.topics._SubscriberImpl."
         "remove_connection.__module__)"], capture_output=True, text=True, timeout=LIMIT,
        env=os.environ | {"PYTHONPATH": f"{source}:{os.environ['PYTHONPATH']}"})
    assert done.stdout == "headless_highgui.course_end\n", done.stderr
