"""A node that is told to end does so between two ticks."""

import threading

import rospy
from turtlesim.node import TurtlesimNode

LIMIT = 20.0  # s


class Screen:
    """Nobody looks, and nothing is closed."""

    closed = wanted = False


class Inbox:
    """Work that takes until `go_on` is set."""

    def __init__(self):
        self.begun, self.go_on, self.ticks = threading.Event(), threading.Event(), 0

    def work(self):
        self.ticks += 1
        self.begun.set()
        assert self.go_on.wait(LIMIT)

    def close(self):
        pass


def without_a_master(node, screen, inbox):
    node._screen, node._inbox = screen, inbox
    node._ticking, node._stopped = threading.RLock(), False


def test_a_shutdown_waits_for_the_tick_and_none_follows(monkeypatch):
    hooks, inbox = [], Inbox()
    for name, stand_in in (("on_shutdown", hooks.append), ("is_shutdown", lambda: False),
                           ("signal_shutdown", lambda reason: None)):
        monkeypatch.setattr(rospy, name, stand_in)
    monkeypatch.setattr(TurtlesimNode, "__init__", without_a_master)
    monkeypatch.setattr(TurtlesimNode, "_step", lambda _: None)
    node = TurtlesimNode(Screen(), inbox)
    running = threading.Thread(target=node.run, daemon=True)
    running.start()
    assert inbox.begun.wait(LIMIT)
    ending = threading.Thread(target=hooks[0], daemon=True)
    ending.start()
    ending.join(0.2)
    assert ending.is_alive()
    inbox.go_on.set()
    ending.join(LIMIT)
    running.join(LIMIT)
    assert not ending.is_alive() and not running.is_alive() and inbox.ticks == 1
