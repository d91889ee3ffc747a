"""The process that publishes commands of browsers, and a zero command when they stop coming.

A process of its own: the page's server may be busy with a large message, be stopped or be killed,
and then, too, the robot must stop in time. It reads commands as lines of JSON from its standard
input, and when that ends, it stops everything and ends as well:

    {"do": "open", "number": 1, "topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
    {"do": "press", "number": 2, "client": 7, "topic": "/cmd_vel", "linear": 0.2, "angular": 0.0}
    {"do": "release", "client": 7}
    {"do": "stop", "topic": "/cmd_vel"}

A line with a number is answered on its standard output by {"number": 2, "taken": false}; `taken`:
another client drives now (see DeadMan, which has no ROS, no thread and no clock: `now` is passed
in, in seconds of a monotonic clock).
"""

import json
import math
import os
import sys
import threading
import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

import rospy
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Twist

HOLD = 0.25  # s that a command lasts; the page repeats a held key at 10 Hz
FLUSH = 0.1  # s in which rospy's threads send what was published last
CONNECTING = 1.0  # s to wait for the robot to connect, so that the first key is not lost
URGENT = -10  # niceness: it does little, but must be in time; only root may set it


@dataclass(frozen=True)
class Command:
    """The command of a held key. Positive: forwards, and to the left."""

    linear: float  # m/s
    angular: float  # rad/s; for a car the steering angle in rad


STOP = Command(0.0, 0.0)


class DrivenByAnother(Exception):
    """Another client drives now; this one must release its keys before it may drive again."""


class DeadMan:
    """One topic with one driver. Each method returns the commands to publish now, oldest first."""

    def __init__(self, hold: float = HOLD) -> None:
        self._hold = hold
        self.driver: Hashable | None = None
        # When `expire` has a command to publish, s; infinite while nobody drives.
        self.until = math.inf
        self._moving = False  # whether the last published command was not a stop
        self._last: Hashable | None = None  # who drove last, until it releases
        self._ousted: set[Hashable] = set()  # earlier drivers that have not released

    def press(self, client: Hashable, command: Command, now: float) -> list[Command]:
        """A command of a client. The latest client becomes the driver, beginning with a stop.

        So two people never drive one robot in turn: the earlier driver, also one whose command
        expired, gets DrivenByAnother until it releases its keys.
        """
        if client in self._ousted:
            raise DrivenByAnother
        if self._last not in (None, client):
            self._ousted.add(self._last)
        self._last = client
        due = self.expire(now)
        taken = self.driver not in (None, client)
        self.driver, self.until = client, now + self._hold
        return self._stop() if taken else [*due, *self._go(command)]

    def release(self, client: Hashable) -> list[Command]:
        """The client released its keys, or disconnected."""
        self._ousted.discard(client)
        if client == self._last:
            self._last = None
        return self._let_go() if client == self.driver else []

    def expire(self, now: float) -> list[Command]:
        """Stop if the driver has sent nothing for the length of a command."""
        return self._let_go() if now >= self.until else []

    def _let_go(self) -> list[Command]:
        self.driver, self.until = None, math.inf
        return self._stop()

    def _stop(self) -> list[Command]:
        stops = [STOP] if self._moving else []
        self._moving = False
        return stops

    def _go(self, command: Command) -> list[Command]:
        self._moving = command != STOP
        return [command]


class Handles:
    """A DeadMan for each topic. All methods may be called from any thread."""

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
        """Pass a command on; DrivenByAnother if another client drives this topic.

        A client drives one topic: what it drove before is stopped.
        """
        with self._changed:
            self._release(client, besides=topic)
            handle = self._handles.setdefault(topic, DeadMan())
            self._send(topic, handle.press(client, command, self._clock()))
            self._changed.notify()

    def release(self, client: Hashable) -> None:
        """The client released the controls, or disconnected."""
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


class Guard:
    """Executes the lines; `answer` is called with an object for each that has a number."""

    def __init__(self, answer: Callable[[dict[str, Any]], None]) -> None:
        self._answer = answer
        self._publishers: dict[str, tuple[rospy.Publisher, Callable]] = {}
        self._handles = Handles(self._publish)

    def do(self, line: str) -> None:
        """Execute one line from the server."""
        order = json.loads(line)
        if order["do"] == "open":  # takes a while; others drive meanwhile
            threading.Thread(target=self._open, args=(order,), daemon=True).start()
        elif order["do"] == "press":
            self._press(order)
        elif order["do"] == "stop":
            self._publish(order["topic"], STOP)
        else:
            self._handles.release(order["client"])

    def close(self) -> None:
        """Stop all robots that are driven."""
        self._handles.close()
        time.sleep(FLUSH)

    def _open(self, order: dict[str, Any]) -> None:
        if order["topic"] not in self._publishers:
            kind, convert = MESSAGES[order["type"]]
            publisher = rospy.Publisher(order["topic"], kind, queue_size=1)
            self._publishers[order["topic"]] = publisher, convert
            end = time.monotonic() + CONNECTING
            while not publisher.get_num_connections() and time.monotonic() < end:
                time.sleep(0.01)
        self._answer({"number": order["number"], "taken": False})

    def _press(self, order: dict[str, Any]) -> None:
        taken = False
        try:
            self._handles.press(order["client"], order["topic"],
                                Command(order["linear"], order["angular"]))
        except DrivenByAnother:
            taken = True
        self._answer({"number": order["number"], "taken": taken})

    def _publish(self, topic: str, command: Command) -> None:
        publisher, convert = self._publishers[topic]
        try:
            publisher.publish(convert(command))
        except rospy.ROSException:
            pass  # the node ends


def main() -> None:
    """Run until the standard input ends."""
    replies = os.fdopen(os.dup(sys.stdout.fileno()), "w", buffering=1)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # keeps rospy's log lines out of the answers
    try:
        os.nice(URGENT)
    except OSError:
        pass  # then at normal priority
    rospy.init_node("sim_viewer_drive", disable_signals=True)
    writing = threading.Lock()

    def answer(reply: dict[str, Any]) -> None:
        try:
            with writing:
                replies.write(json.dumps(reply) + "\n")
        except OSError:
            pass  # the server has ended, and with it the input

    guard = Guard(answer)
    try:
        for line in sys.stdin:
            guard.do(line)
    finally:
        guard.close()
        rospy.signal_shutdown("the page has ended")


if __name__ == "__main__":
    main()
