"""Driving from browsers: their commands on a topic of the robot, stopped by a thread of its own.

The thread and not the loop watches the time: a loop that is late must not let a robot drive on.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Hashable

import rosgraph
import rospy
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Twist

from sim_viewer.context import Context, Node
from sim_viewer.dead_man import STOP, Command, DeadMan, HandleTaken
from sim_viewer.registry import Refused, operation

FASTEST = 20.0  # m/s and rad/s; more is a slip of the hand, whatever the robot
FLUSH = 0.1  # s in which rospy's threads send what was published last


class Handles:
    """A handle for each topic. All methods may be called from any thread."""

    def __init__(self, publish: Callable[[str, Command], None],
                 clock: Callable[[], float] = time.monotonic) -> None:
        self._publish = publish
        self._clock = clock
        self._handles: dict[str, DeadMan] = {}
        self._changed = threading.Condition()
        self._closed = False
        self._timer = threading.Thread(target=self._stop_in_time, name="dead man", daemon=True)
        self._timer.start()

    def press(self, client: Hashable, topic: str, command: Command) -> None:
        """Pass a command on; HandleTaken if another client drives this topic.

        A client drives one topic: what it drove before is stopped.
        """
        with self._changed:
            self._release(client, besides=topic)
            handle = self._handles.setdefault(topic, DeadMan())
            self._send(topic, handle.press(client, command, self._clock()))
            self._changed.notify()

    def release(self, client: Hashable) -> None:
        """The client let go, or is gone."""
        with self._changed:
            self._release(client)

    def close(self) -> None:
        """Stop everything that is driven, and the thread."""
        with self._changed:
            self._closed = True
            for topic, handle in self._handles.items():
                self._send(topic, handle.release(handle.driver))
            self._changed.notify()
        self._timer.join()

    def _release(self, client: Hashable, besides: str = "") -> None:
        for topic, handle in self._handles.items():
            if topic != besides:
                self._send(topic, handle.release(client))

    def _send(self, topic: str, commands: list[Command]) -> None:
        for command in commands:
            self._publish(topic, command)

    def _stop_in_time(self) -> None:
        with self._changed:
            while not self._closed:
                now = self._clock()
                for topic, handle in self._handles.items():
                    self._send(topic, handle.expire(now))
                due = min((handle.until for handle in self._handles.values()), default=float("inf"))
                self._changed.wait(None if due == float("inf") else max(due - now, 0.0))


def twist(command: Command) -> Twist:
    """For robots that turn on the spot."""
    message = Twist()
    message.linear.x, message.angular.z = command.linear, command.angular
    return message


def ackermann(command: Command) -> AckermannDriveStamped:
    """For cars: the angle is that of the front wheels."""
    message = AckermannDriveStamped()
    message.header.stamp = rospy.Time.now()
    message.drive.speed, message.drive.steering_angle = command.linear, command.angular
    return message


MESSAGES = {"geometry_msgs/Twist": (Twist, twist),
            "ackermann_msgs/AckermannDriveStamped": (AckermannDriveStamped, ackermann)}


class Drive:
    """The topics that browsers drive, one publisher each, kept while the node runs."""

    def __init__(self, node: Node) -> None:
        self._publishers: dict[str, tuple[rospy.Publisher, Callable]] = {}
        self._opening = threading.Lock()
        self._known: set[int] = set()  # clients whose end is watched
        self.handles = Handles(self._publish)

    def open(self, topic: str) -> str:
        """Get ready to publish on a topic that a robot listens to; its type. Asks the master."""
        name = rospy.resolve_name(topic)
        found = driven_topics()
        if name not in found:
            raise Refused(f"no robot listens to {name}; there is {', '.join(found) or 'none yet'}")
        kind, convert = MESSAGES[found[name]]
        with self._opening:
            if name not in self._publishers:
                publisher = rospy.Publisher(name, kind, queue_size=1)
                self._publishers[name] = publisher, convert
        return found[name]

    def is_open(self, topic: str) -> bool:
        return rospy.resolve_name(topic) in self._publishers

    def press(self, context: Context, topic: str, command: Command) -> None:
        """One message of a held key, in the loop's thread."""
        if context.client not in self._known:
            self._known.add(context.client)
            context.on_close(lambda: self._forget(context.client))
        self.handles.press(context.client, rospy.resolve_name(topic), command)

    def close(self) -> None:
        """The node ends: nothing may be left driving."""
        self.handles.close()
        time.sleep(FLUSH)

    def _forget(self, client: int) -> None:
        self._known.discard(client)
        self.handles.release(client)

    def _publish(self, topic: str, command: Command) -> None:
        publisher, convert = self._publishers[topic]
        try:
            publisher.publish(convert(command))
        except rospy.ROSException:
            pass  # the node ends


def driven_topics() -> dict[str, str]:
    """Topics that somebody listens to and whose type we can drive by, with that type, sorted."""
    master = rosgraph.Master(rospy.get_name())
    types = dict(master.getTopicTypes())
    listened = sorted(name for name, _ in master.getSystemState()[1])
    return {name: types[name] for name in listened if types.get(name) in MESSAGES}


@operation("drive_topics")
async def drive_topics(context: Context) -> list[dict[str, str]]:
    """What can be driven: [{"topic": name, "type": type}]."""
    found = await context.run_in_thread(driven_topics)
    return [{"topic": name, "type": kind} for name, kind in found.items()]


@operation("drive_open", control=True)
async def drive_open(context: Context, topic: str = "cmd_vel") -> dict[str, str]:
    """Get ready to drive, so that the first key is not lost while connections are made."""
    kind = await context.run_in_thread(context.node.shared(Drive).open, _legal(topic))
    return {"topic": rospy.resolve_name(topic), "type": kind}


@operation("drive", control=True)
async def drive(context: Context, linear: float, angular: float, topic: str = "cmd_vel") -> None:
    """A key is held. The first message on a topic only opens it: what waits may be overtaken by a
    release, and must not drive after that."""
    if max(abs(linear), abs(angular)) > FASTEST:
        raise Refused(f"drive: {linear:g} m/s and {angular:g} rad/s are more than {FASTEST:g}")
    driven = context.node.shared(Drive)
    if not driven.is_open(_legal(topic)):
        await context.run_in_thread(driven.open, topic)
        return
    try:
        driven.press(context, topic, Command(linear, angular) if linear or angular else STOP)
    except HandleTaken:
        raise Refused("somebody else drives now; let go of the keys, then press again") from None


@operation("drive_release", control=True)
async def drive_release(context: Context) -> None:
    """All keys are up."""
    context.node.shared(Drive).handles.release(context.client)


def _legal(topic: str) -> str:
    if len(topic) > 256 or not rosgraph.names.is_legal_name(topic) or topic.startswith("~"):
        raise Refused(f"{topic[:40]!r} is no name of a topic; cmd_vel is one")
    return topic
