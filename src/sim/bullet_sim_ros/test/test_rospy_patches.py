"""What a node does on the word of others: of the master, late; of strangers, if it may."""

import threading
from types import SimpleNamespace

import pytest
import rospy.impl.registration
from rospy.impl.masterslave import ROSHandler
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_service import ServiceImpl

from bullet_sim_ros.rospy_patches import ask_before_obeying, keep_every_publisher

LIMIT = 60.0  # s


class Node:
    """In the place of rospy's slave node: keeps what it connects to, until that is enough."""

    def __init__(self, enough):
        self.connected, self._enough = set(), enough
        self.all_there = threading.Event()

    @property
    def done(self):
        return self.all_there.is_set()

    def _connect_topic(self, topic, uri):
        self.connected.add((topic, uri))
        if len(self.connected) == self._enough:
            self.all_there.set()
        return 1, "", 0


@pytest.fixture
def manager_of(monkeypatch):
    monkeypatch.setattr(RegManager, "publisher_update", RegManager.publisher_update)
    monkeypatch.setattr(rospy.impl.registration, "add_preshutdown_hook", lambda _hook: None)
    monkeypatch.setattr(rospy.impl.registration, "get_topic_manager",
                        lambda: SimpleNamespace(check_all=lambda: None))
    keep_every_publisher()
    return RegManager


def test_an_old_answer_hides_no_publisher(manager_of):
    node = Node(enough=4)
    manager = manager_of(node)
    manager.publisher_update("/left", ["http://a"])
    manager.publisher_update("/right", ["http://a", "http://b"])  # the master's call
    manager.publisher_update("/right", ["http://c"])  # the answer to the subscription, from before
    manager.publisher_update("/left", [])
    worker = threading.Thread(target=manager.run, daemon=True)
    worker.start()
    assert node.all_there.wait(LIMIT), node.connected
    worker.join(LIMIT)
    assert node.connected == {("/left", "http://a"), ("/right", "http://a"),
                              ("/right", "http://b"), ("/right", "http://c")}


class Service:
    """In the place of rospy's: notes its answers, and the errors that it writes."""

    resolved_name = "/srv"

    def __init__(self):
        self.said = []

    def _write_service_error(self, _transport, text):
        self.said.append(text)


@pytest.mark.parametrize("may", [True, False])
def test_what_strangers_ask_is_done_only_if_it_is_allowed(monkeypatch, may):
    done, asked, service = [], [], Service()
    for name in ("_connect_topic", "paramUpdate", "shutdown"):
        monkeypatch.setattr(ROSHandler, name, lambda _handler, *call: done.append(call))
    monkeypatch.setattr(ServiceImpl, "_handle_request",
                        lambda _service, _transport, request: done.append((request,)))
    ask_before_obeying(lambda *what: asked.append(what) or may)
    ROSHandler._connect_topic(None, "/cmd_vel", "http://a")
    ROSHandler.paramUpdate(None, "/x", "/rate", 5)
    ROSHandler.shutdown(None, "/x", "end")
    ServiceImpl._handle_request(service, None, "request")
    assert asked == [("publisher", "/cmd_vel", "http://a"), ("parameter", "/rate", ""),
                     ("shutdown", "", ""), ("service", "/srv", "")]
    assert done == ([("/cmd_vel", "http://a"), ("/x", "/rate", 5), ("/x", "end"), ("request",)]
                    if may else [])
    assert bool(service.said) is not may
