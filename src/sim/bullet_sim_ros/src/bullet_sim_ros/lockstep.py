"""Lockstep: after each camera frame or sensor message, the world waits for the answer to it."""

import time
from collections.abc import Callable

import rospy

from bullet_sim_ros.mailbox import Mailbox

WARNING_PERIOD = 10.0  # s, wall
LOOK = 0.1  # s, wall clock: how often to check whether the simulation is to stop


class Lockstep:
    """Waits for one message on each of its topics; without topics it never waits.

    A message counts as received after the loop has run its command: if a plugin subscribes to the
    topic, its subscription calls `receive` after it has posted its command in the mailbox.
    """

    def __init__(self, topics: str, timeout: float, mailbox: Mailbox, sensor: str = ""):
        """`sensor`: the topic after whose messages it waits; empty: after each camera frame."""
        self._sensor = rospy.resolve_name(sensor) if sensor else ""
        self.topics = frozenset(rospy.resolve_name(topic) for topic in split(topics))
        self.unanswered = 0  # frames after which the world went on without an answer
        self.each_question: list[Callable[[], None]] = []  # called in the loop, before it waits
        self._timeout = timeout  # s, wall
        self._mailbox = mailbox
        self._expected: set[str] = set()  # topics whose message is still to come
        self._asker: object = None  # the plugin whose frame or message is to be answered
        self._next_warning = 0.0  # s, wall
        # By topic, the plugins that call `receive`, in the order in which they subscribed.
        self._plugins: dict[str, list[object]] = {topic: [] for topic in self.topics}
        self._subscribers: dict[str, rospy.Subscriber] = {}  # where no plugin does

    def listen(self) -> None:
        """Subscribe to topics without a plugin, before time begins, so that no answer is lost."""
        for topic, plugins in self._plugins.items():
            if not plugins and topic not in self._subscribers:
                self._subscribers[topic] = rospy.Subscriber(
                    topic, rospy.AnyMsg, lambda _msg, topic: self.receive(topic),
                    callback_args=topic, tcp_nodelay=True)

    def expect(self, asker: object = None, sensor: str = "") -> None:
        """`asker` publishes a frame, or a message on the topic `sensor`.

        The world waits for the answer before the next step.
        """
        if sensor == self._sensor:
            self._asker, self._expected = asker, set(self.topics)

    def subscribe(self, topic: str, plugin: object) -> None:
        """A plugin is about to subscribe; it will call `receive` after each message."""
        self._plugins[topic].append(plugin)
        if topic in self._subscribers:  # has another message type; rospy allows one per topic
            self._subscribers.pop(topic).unregister()
            # A message in transit may reach neither subscriber: it must not be waited for.
            self._mailbox.post(lambda: self._expected.discard(topic))

    def unsubscribe(self, topic: str, plugin: object) -> None:
        """That plugin has ended."""
        self._plugins[topic].remove(plugin)
        self.listen()

    def receive(self, topic: str, plugin: object = None) -> None:
        """From any thread: a message came, to a plugin or to our own subscriber.

        A robot may have two drives on one topic. rospy calls them in the order in which they
        subscribed, so after the last one all have posted their commands.
        """
        if plugin is None or self._plugins[topic][-1:] == [plugin]:
            self._mailbox.post(lambda: self._expected.discard(topic))

    def cancel(self, asker: object = None) -> None:
        """Stop waiting; with an `asker`, only if the wait is for an answer to it."""
        if asker is None or asker is self._asker:
            self._expected.clear()

    def wait(self, stopped: Callable[[], bool]) -> None:
        """Run the mailbox's calls until the answer is there or the time-out is over."""
        if self._expected:
            self.note()
        until = time.monotonic() + self._timeout
        while self._expected and not stopped():
            left = until - time.monotonic()
            if left <= 0:
                self.unanswered += 1
                self._warn()
                self.cancel()
                return
            self._mailbox.run_pending(min(left, LOOK))

    def note(self) -> None:
        """In the loop: an image, or a sensor's message, is to be answered now."""
        for observe in self.each_question:
            observe()

    def _warn(self) -> None:
        """Warn, limited by wall time: rospy's throttle uses simulated time, which hardly passes."""
        now = time.monotonic()
        if now < self._next_warning:
            return
        self._next_warning = now + WARNING_PERIOD
        rospy.logwarn(
            "lockstep: no message on %s within %g s of a %s; going on without. Does the follower "
            "answer every one there?", ", ".join(sorted(self._expected)), self._timeout,
            f"message on {self._sensor}" if self._sensor else "camera frame")


def split(topics: str) -> list[str]:
    """The topic names in a text, in which spaces or commas separate them."""
    return topics.replace(",", " ").split()
