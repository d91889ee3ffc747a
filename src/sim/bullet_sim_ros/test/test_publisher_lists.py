"""What the master says of a topic's publishers, read in another order than it was said."""

import threading
from types import SimpleNamespace

import pytest
import rospy.impl.registration
from rospy.impl.registration import RegManager

from bullet_sim_ros.publisher_lists import keep_every_publisher

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
