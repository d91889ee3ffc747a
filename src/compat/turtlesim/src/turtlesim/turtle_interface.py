"""One turtle's topics and services, NAME/cmd_vel and the others.

Work that ROS's threads leave waits for the loop, which alone touches the pond.
"""

from __future__ import annotations

import math
import queue
from collections.abc import Callable, Iterable
from concurrent.futures import CancelledError, Future
from typing import Any

import numpy as np
import rospy
from geometry_msgs.msg import Twist

from turtlesim.msg import Color, Pose
from turtlesim.pond.pond import Pond, PondError, Turtle
from turtlesim.srv import (
    SetPen,
    SetPenResponse,
    TeleportAbsolute,
    TeleportAbsoluteResponse,
    TeleportRelative,
    TeleportRelativeResponse,
)


class Inbox:
    """Everything is done in the order of arrival, once a tick."""

    def __init__(self) -> None:
        self._work: queue.SimpleQueue[tuple[Future, Callable, tuple]] = queue.SimpleQueue()
        self._closed = False

    def put(self, function: Callable, *arguments: Any) -> Future:
        """From any thread; does not wait."""
        answer: Future = Future()
        self._work.put((answer, function, arguments))
        if self._closed:
            self.close()
        return answer

    def call(self, function: Callable, *arguments: Any) -> Any:
        """From a service's thread: waits for the answer; ServiceException if there is none."""
        try:
            return self.put(function, *arguments).result()
        except PondError as error:
            raise rospy.ServiceException(str(error)) from error
        except CancelledError:
            raise rospy.ServiceException("turtlesim has ended") from None

    def work(self) -> None:
        """Do what has arrived. The loop calls this."""
        for _ in range(self._work.qsize()):
            answer, function, arguments = self._work.get()
            try:
                answer.set_result(function(*arguments))
            except Exception as error:
                answer.set_exception(error)

    def close(self) -> None:
        """Reject all pending requests, and those that come later."""
        self._closed = True
        while not self._work.empty():
            self._work.get()[0].cancel()


class TurtleInterface:
    """Speaks for whichever turtle has this name: a reset gives it a new one."""

    def __init__(self, name: str, pond: Pond, inbox: Inbox, clock) -> None:
        """`clock()` is now, in the seconds that the pond is stepped with."""
        self._name, self._pond, self._inbox, self._clock = name, pond, inbox, clock
        self._pose = rospy.Publisher(f"{name}/pose", Pose, queue_size=1)
        self._color = rospy.Publisher(f"{name}/color_sensor", Color, queue_size=1)
        self._parts = [
            self._pose,
            self._color,
            rospy.Subscriber(f"{name}/cmd_vel", Twist, self._command, queue_size=1),
        ]
        self._services = [
            rospy.Service(f"{name}/set_pen", SetPen, self._set_pen),
            rospy.Service(f"{name}/teleport_absolute", TeleportAbsolute, self._teleport_absolute),
            rospy.Service(f"{name}/teleport_relative", TeleportRelative, self._teleport_relative),
        ]

    def publish(self) -> None:
        turtle = self._turtle()
        self._pose.publish(pose_to_msg(turtle))
        self._color.publish(*turtle.color)

    def close(self) -> None:
        for part in self._parts:
            part.unregister()
        for service in self._services:
            service.shutdown(f"turtle [{self._name}] is gone")

    def _turtle(self) -> Turtle:
        try:
            return self._pond.turtles[self._name]
        except KeyError:
            raise PondError(f"turtle [{self._name}] is gone") from None

    def _command(self, message: Twist) -> None:
        speeds = message.linear.x, message.linear.y, message.angular.z
        if all(map(math.isfinite, speeds)):
            now = self._clock()
            self._inbox.put(lambda: self._turtle().command(*speeds, now))
        else:
            rospy.logwarn_throttle(
                1.0, f"{self._name}/cmd_vel: {speeds} are not finite numbers: ignored"
            )

    def _set_pen(self, request) -> SetPenResponse:
        color = request.r, request.g, request.b
        self._inbox.call(
            lambda: self._turtle().set_pen(color, request.width, bool(request.off))
        )
        return SetPenResponse()

    def _teleport_absolute(self, request) -> TeleportAbsoluteResponse:
        to = request.x, request.y, request.theta
        require_finite(to)
        self._inbox.call(lambda: self._turtle().teleport_absolute(*to))
        return TeleportAbsoluteResponse()

    def _teleport_relative(self, request) -> TeleportRelativeResponse:
        by = request.linear, request.angular
        require_finite(by)
        self._inbox.call(lambda: self._turtle().teleport_relative(*by))
        return TeleportRelativeResponse()


def require_finite(numbers: Iterable[float]) -> None:
    if not all(map(math.isfinite, numbers)):
        raise rospy.ServiceException("a turtle goes only where numbers are finite")


def pose_to_msg(turtle: Turtle) -> Pose:
    """What is larger than a float32 becomes infinite, as in upstream's C++."""
    values = turtle.x, turtle.y, turtle.theta, turtle.speed, turtle.turn_rate
    with np.errstate(over="ignore"):
        return Pose(*np.array(values).astype(np.float32).tolist())
