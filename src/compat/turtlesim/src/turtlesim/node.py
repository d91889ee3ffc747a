"""The node turtlesim: the pond's services, its turtles' topics, and the loop that steps it."""

from __future__ import annotations

import random
import time

import numpy as np
import rospy
from rosgraph.names import is_legal_name
from std_srvs.srv import Empty, EmptyResponse

from turtlesim.pond.canvas import SIDE, Color
from turtlesim.pond.pond import BACKGROUND, FIRST, TICK, Pond, PondError
from turtlesim.srv import Kill, KillResponse, Spawn, SpawnResponse
from turtlesim.turtle_interface import Inbox, TurtleInterface, require_finite

_NAMES = ("~background_r", "~background_g", "~background_b")


def declare_background() -> None:
    """Put what is not set on the server, so that `rosparam list` shows it."""
    for name, default in zip(_NAMES, BACKGROUND):
        if not rospy.has_param(name):
            rospy.set_param(name, default)


def read_background() -> Color:
    """A value that is no colour counts as not set, with one warning."""
    red, green, blue = (_read(name, default) for name, default in zip(_NAMES, BACKGROUND))
    return red, green, blue


def _read(name: str, default: int) -> int:
    value = rospy.get_param(name, default)
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 255:
        return value
    rospy.logwarn("parameter %s must be a whole number from 0 to 255, not %r: %d is used",
                  rospy.resolve_name(name), value, default)
    return default


FRAME_TICKS = 2  # a picture every second tick, 31 in a second


class TurtlesimNode:
    """Make it after rospy.init_node; `screen` has show(picture), `wanted` and `closed`."""

    def __init__(self, screen) -> None:
        rospy.loginfo("Starting turtlesim with node name %s", rospy.get_name())
        self._screen, self._inbox = screen, Inbox()
        declare_background()
        self._pond = Pond(random.Random(), read_background())
        self._turtles: dict[str, TurtleInterface] = {}
        self._greet(FIRST)
        self._meet()
        call = self._inbox.call
        rospy.Service("clear", Empty, lambda _: call(self._clear))
        rospy.Service("reset", Empty, lambda _: call(self._reset))
        rospy.Service("spawn", Spawn, lambda request: call(self._spawn, request))
        rospy.Service("kill", Kill, lambda request: call(self._kill, request))

    def run(self) -> None:
        """Until ROS or the screen is closed. A late tick is not made up for, as in upstream."""
        tick, due = 0, time.monotonic()
        while not rospy.is_shutdown() and not self._screen.closed:
            self._inbox.work()
            self._step()
            if tick % FRAME_TICKS == 0 and self._screen.wanted:
                self._screen.show(self._pond.picture())
            tick += 1
            due = max(due + TICK, time.monotonic() - TICK)
            time.sleep(max(0.0, due - time.monotonic()))
        self._inbox.close()
        rospy.signal_shutdown("the window was closed")

    def _step(self) -> None:
        for x, y in self._pond.step(time.monotonic()):
            # Upstream prints y as its window counts it, from the top.
            rospy.logwarn("Oh no! I hit the wall! (Clamping from [x=%f, y=%f])", x, SIDE - y)
        for turtle in self._turtles.values():
            turtle.publish()

    def _clear(self) -> EmptyResponse:
        rospy.loginfo("Clearing turtlesim.")
        self._pond.clear(read_background())
        return EmptyResponse()

    def _reset(self) -> EmptyResponse:
        rospy.loginfo("Resetting turtlesim.")
        self._pond.reset(read_background())
        self._greet(FIRST)
        self._meet()
        return EmptyResponse()

    def _spawn(self, request) -> SpawnResponse:
        require_finite((request.x, request.y, request.theta))
        if request.name and not is_legal_name(request.name):
            raise PondError(f"[{request.name}] cannot be a turtle's name: "
                            "begin with a letter, go on with letters, digits and _")
        try:
            name = self._pond.spawn(request.name, request.x, request.y, request.theta)
        except PondError as error:
            rospy.logerr("%s", error)
            raise
        self._greet(name)
        self._meet()
        return SpawnResponse(name)

    def _kill(self, request) -> KillResponse:
        try:
            self._pond.kill(request.name)
        except PondError as error:
            rospy.logerr("%s", error)
            raise
        self._meet()
        return KillResponse()

    def _greet(self, name: str) -> None:
        turtle = self._pond.turtles[name]
        where = np.float32([turtle.x, turtle.y, turtle.theta])  # upstream's precision, in its text
        rospy.loginfo("Spawning turtle [%s] at x=[%f], y=[%f], theta=[%f]", name, *where)

    def _meet(self) -> None:
        """Topics and services for the turtles that are new, none for those that are gone."""
        for name in self._turtles.keys() - self._pond.turtles.keys():
            self._turtles.pop(name).close()
        for name in self._pond.turtles.keys() - self._turtles.keys():
            self._turtles[name] = TurtleInterface(name, self._pond, self._inbox, time.monotonic)
