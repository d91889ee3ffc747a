"""The process that publishes commands of browsers, and a zero command when they stop coming.

A process of its own: the page's server may be busy with a large message, be stopped or be killed,
and then, too, the robot must stop in time. It reads commands as lines of JSON from its standard
input, and when that ends, it stops everything and ends as well:

    {"do": "open", "number": 1, "topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
    {"do": "press", "number": 2, "client": 7, "topic": "/cmd_vel", "linear": 0.2, "angular": 0.0}
    {"do": "release", "client": 7}
    {"do": "stop", "topic": "/cmd_vel"}

A line with a number is answered on its standard output by {"number": 2, "taken": false}; `taken`:
another client drives now (see dead_man.py).
"""

import json
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import rospy
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Twist

from sim_viewer.dead_man import STOP, Command, DrivenByAnother
from sim_viewer.handles import Handles

FLUSH = 0.1  # s in which rospy's threads send what was published last
CONNECTING = 1.0  # s to wait for the robot to connect, so that the first key is not lost
URGENT = -10  # niceness: it does little, but must be in time; only root may set it


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
