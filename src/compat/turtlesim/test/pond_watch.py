"""What the tests here share: waiting for a condition, the last messages of a topic, log lines."""

import subprocess
import threading
import time
import xmlrpc.client

import rosgraph
import rospy
from rosgraph_msgs.msg import Log
from roslib.packages import find_node

LIMIT = 60.0  # s, for whatever is waited for


def wait_until(condition, what, limit=LIMIT):
    """What `condition` returned as soon as it was true."""
    end = time.monotonic() + limit
    while not (found := condition()):
        assert time.monotonic() < end, f"waited {limit} s in vain for {what}"
        time.sleep(0.01)
    return found


def start_node(program, *arguments, **options):
    """One of turtlesim's nodes in a session of its own."""
    return subprocess.Popen([*find_node("turtlesim", program)[:1], *arguments],
                            start_new_session=True, **options)


def service_names():
    """All services that the master knows."""
    return {name for name, _ in rosgraph.Master("/pond_watch").getSystemState()[2]}


def sends_to_us(node, topic):
    """Whether a node has its link to us open; before that its messages are lost. Only it knows."""
    uri = rosgraph.Master("/pond_watch").lookupNode(node)
    _, _, links = xmlrpc.client.ServerProxy(uri).getBusInfo("/pond_watch")
    return any(receiver == rospy.get_name() and direction == "o" and name == topic and is_open
               for _, receiver, direction, _, name, is_open, *_ in links)


class Topic:
    """Keeps the messages of a topic."""

    def __init__(self, name, kind):
        self.messages, self.arrived = [], threading.Condition()
        self.name, self.count = name, 0
        self.subscriber = rospy.Subscriber(name, kind, self.keep, queue_size=100)

    def keep(self, message):
        with self.arrived:
            self.messages.append(message)
            self.count += 1
            self.arrived.notify_all()

    def forget(self):
        with self.arrived:
            self.messages.clear()

    def wait_for(self, fits, what):
        """The first message from now on, or kept already, that fits."""
        seen = 0
        end = time.monotonic() + LIMIT
        with self.arrived:
            while True:
                for message in self.messages[seen:]:
                    if fits(message):
                        return message
                seen = len(self.messages)
                left = end - time.monotonic()
                assert left > 0 and self.arrived.wait(left), (
                    f"{self.name}: {what} did not come; the last: {self.messages[-1:]}"
                )

    def next(self, number=1):
        """The messages from now on; the first may have been on its way, so it is left out."""
        with self.arrived:
            start = len(self.messages) + 1
            came = self.arrived.wait_for(lambda: len(self.messages) >= start + number, LIMIT)
            assert came, f"{self.name}: no {number} messages"
            return self.messages[start : start + number]


class LogLines(Topic):
    """What the node says on /rosout."""

    def __init__(self):
        super().__init__("/rosout", Log)

    def wait_for_line(self, text, level=None):
        return self.wait_for(
            lambda line: line.msg == text and level in (None, line.level), f"{text!r}"
        )
