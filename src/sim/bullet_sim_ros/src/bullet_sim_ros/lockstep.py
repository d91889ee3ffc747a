"""After each camera frame the world stands still until somebody has answered it."""

from __future__ import annotations

import time
from collections.abc import Callable

import rospy

from bullet_sim_ros.mailbox import Mailbox

WARNING_PERIOD = 10.0  # s, wall
LOOK = 0.1  # s, wall: how often to see whether the simulation has been told to stop


class Lockstep:
    """Waits for one message on a topic; without a topic it never waits.

    The message is heard in the loop, behind the commands that it carries: where a plugin takes the
    same topic, its own subscription tells us after it has left its command in the mailbox.
    """

    def __init__(self, topic: str, timeout: float, mailbox: Mailbox):
        self.topic = rospy.resolve_name(topic) if topic else ""
        self._timeout = timeout  # s, wall
        self._mailbox = mailbox
        self._expecting = False
        self._next_warning = 0.0  # s, wall
        self._plugins: list[object] = []  # that tell us, in the order in which they subscribed
        self._subscriber: rospy.Subscriber | None = None  # where none does

    def listen(self) -> None:
        """Subscribe to the topic if no plugin does: before time begins, for answers miss nobody."""
        if self.topic and not self._plugins and self._subscriber is None:
            self._subscriber = rospy.Subscriber(
                self.topic, rospy.AnyMsg, lambda _msg: self.hear(), tcp_nodelay=True)

    def expect(self) -> None:
        """A frame was taken for somebody: wait for the answer before the next step."""
        self._expecting = bool(self.topic)

    def join(self, plugin: object) -> None:
        """A plugin is about to subscribe; it will call `hear` after each message of the topic."""
        self._plugins.append(plugin)
        if self._subscriber is not None:  # of another message type, and there is one per topic
            self._subscriber.unregister()
            self._subscriber = None

    def leave(self, plugin: object) -> None:
        """That plugin is gone."""
        self._plugins.remove(plugin)
        self.listen()

    def hear(self, plugin: object = None) -> None:
        """From any thread: a message came, to a plugin or to our own subscriber.

        A robot may have two drives on one topic. rospy tells them in the order in which they
        subscribed, so with the last one all have left their commands.
        """
        if plugin is None or self._plugins[-1:] == [plugin]:
            self._mailbox.leave(self.cancel)

    def cancel(self) -> None:
        """Wait no longer."""
        self._expecting = False

    def wait(self, stopped: Callable[[], bool]) -> None:
        """Run what comes into the mailbox until the answer is there or the time is over."""
        until = time.monotonic() + self._timeout
        while self._expecting and not stopped():
            left = until - time.monotonic()
            if left <= 0:
                self._expecting = False
                self._warn()
                return
            self._mailbox.run_pending(min(left, LOOK))

    def _warn(self) -> None:
        """By the wall clock: rospy's own throttle goes by simulated time, which hardly passes."""
        now = time.monotonic()
        if now < self._next_warning:
            return
        self._next_warning = now + WARNING_PERIOD
        rospy.logwarn(
            "lockstep: no message on %s within %g s of a camera frame; going on without. Does the "
            "follower answer every image there?", self.topic, self._timeout)
