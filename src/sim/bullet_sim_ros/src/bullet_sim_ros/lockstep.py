"""Lockstep: after each camera frame or sensor message, the world waits for the answer to it."""

import math
import time
from collections.abc import Callable

import rosgraph
import rospy
from rospy.impl.registration import get_topic_manager

from bullet_sim_ros.mailbox import Mailbox

WARNING_PERIOD = 10.0  # s, wall
LOOK = 0.1  # s, wall clock: how often to check whether the simulation is to stop
# s, wall, of a wait without a limit, until a line says whom it is for: a program that has ended is
# missed soon, and one that stands at a breakpoint does not want a line at each step.
MISSED, STANDING = 1.0, 10.0
SAID_AGAIN = 60.0  # s, wall: the same line


class Lockstep:
    """Waits for one message on each of its topics; without topics it never waits.

    A message counts as received after the loop has run its command: if a plugin subscribes to the
    topic, its subscription calls `receive` after it has posted its command in the mailbox.
    """

    def __init__(self, topics: str, timeout: float, mailbox: Mailbox, sensor: str = ""):
        """`timeout`: s, wall; 0: none, so that a program may stand at a breakpoint.

        `sensor`: the topic after whose messages it waits; empty: after each camera frame.
        """
        self._sensor = rospy.resolve_name(sensor) if sensor else ""
        self.topics = frozenset(rospy.resolve_name(topic) for topic in split(topics))
        self.unanswered = 0  # frames after which the world went on without an answer
        self.each_question: list[Callable[[], None]] = []  # called in the loop, before it waits
        self._timeout = timeout  # s, wall; 0: none
        self._mailbox = mailbox
        self._expected: set[str] = set()  # topics whose message is still to come
        self._asker: object = None  # the plugin whose frame or message is to be answered
        self._next_warning = 0.0  # s, wall
        self._said, self._said_at = ("", ""), -math.inf  # topic, who answers there; s, wall
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

    def wait(self, stopped: Callable[[], bool]) -> bool:
        """Run the mailbox's calls until the answer is there or the time-out is over.

        True if a program stood for long, and the wall clock's pace begins anew.
        """
        if self._expected:
            self.note()
        began = time.monotonic()
        until = began + (self._timeout or math.inf)
        while self._expected and not stopped():
            now = time.monotonic()
            if now >= until:
                self.unanswered += 1
                self._warn()
                self.cancel()
                break
            if not self._timeout:
                self._say_whom(now, now - began)
            self._mailbox.run_pending(min(until - now, LOOK))
        return not self._timeout and time.monotonic() - began > MISSED

    @property
    def endless(self) -> bool:
        """Whether it waits for ever."""
        return bool(self.topics) and not self._timeout

    def admit(self, node: str, connect: Callable[[bool], None]) -> None:
        """Where it waits for ever: `connect` a new subscriber of a sensor, in the loop's thread,
        once its answers are heard here: one that was sent before would be lost. It waits for
        MISSED at most, and for STANDING if the master knows that it answers.

        `connect(True)` sends it the last image, too: that which the world waits at. An answer to
        any other one would be taken for that of the next.
        """
        began = time.monotonic()
        while not all(node in answering(topic) for topic in self.topics):
            waited = time.monotonic() - began
            if waited > MISSED and (waited > STANDING or not self._will_answer(node)):
                break
            time.sleep(LOOK / 10 if waited < MISSED else LOOK)
        self._mailbox.post(lambda: connect(bool(self._expected)))

    def _will_answer(self, node: str) -> bool:
        """Whether the master knows a node as a publisher of all topics."""
        try:
            publishers = dict(rosgraph.Master(rospy.get_name()).getSystemState()[0])
        except (OSError, rosgraph.MasterException):
            return False
        return all(node in publishers.get(topic, ()) for topic in self.topics)

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


    def _say_whom(self, now: float, waited: float) -> None:
        """Say whom a wait without a limit is for, and how to go on."""
        if waited < MISSED:
            return
        topic = min(self._expected)
        who = ", ".join(answering(topic))
        again = SAID_AGAIN if (topic, who) == self._said else 0.0
        if waited < (STANDING if who else MISSED) or now - self._said_at < again:
            return
        self._said, self._said_at = (topic, who), now
        if who:
            rospy.logwarn(
                "lockstep: the world stands still until %s sends on %s: lockstep_timeout is 0. If "
                "it stands at a breakpoint, let it go on; if it hangs, start it again", who, topic)
            return
        kind = getattr(get_topic_manager().get_subscriber_impl(topic), "type", "*")
        rospy.logwarn(
            "lockstep: the world stands still for a message on %s, where nobody sends any more: "
            "start the program again, or send one: rostopic pub -1 %s %s '{}'", topic, topic,
            "TYPE" if kind == "*" else kind)


def answering(topic: str) -> list[str]:
    """The nodes whose messages on a topic arrive here, sorted; of a killed one nothing does."""
    subscriber = get_topic_manager().get_subscriber_impl(topic)
    return sorted({link.callerid_pub for link in (subscriber.connections if subscriber else ())
                   if link.socket is not None and not link.done})


def split(topics: str) -> list[str]:
    """The topic names in a text, in which spaces or commas separate them."""
    return topics.replace(",", " ").split()
