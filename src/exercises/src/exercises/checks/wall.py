"""A node that stops a (simulated) turtle: from /turtle1/pose to /turtle1/cmd_vel."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import rospy
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose

from exercises.finding import Finding, holds, near
from exercises.node import PAUSE, START, running

ALONG = 5.5  # m, x of its start, and its y


class Turtle:
    """A turtle that drives along x with the last command."""

    def __init__(self) -> None:
        self.x, self.speed, self.commands = ALONG, 0.0, 0
        self._poses = rospy.Publisher("/turtle1/pose", Pose, queue_size=1)
        rospy.Subscriber("/turtle1/cmd_vel", Twist, self._take, queue_size=1)

    def _take(self, command: Twist) -> None:
        self.speed, self.commands = command.linear.x, self.commands + 1

    def live(self) -> bool:
        """Advance by one step and publish the pose; returns whether any command has come."""
        self.x += PAUSE * self.speed
        self._poses.publish(Pose(x=self.x, y=ALONG, linear_velocity=self.speed))
        return self.commands > 0


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """It must set off, and stop before the wall."""
    with running(file) as until:
        turtle = Turtle()
        commanded = until(turtle.live, START)
        yield holds("commands on /turtle1/cmd_vel", str(turtle.commands), "1 or more", commanded)
        until(lambda: turtle.live() and False, limits["seconds"])
        middle = (limits["least_x"] + limits["most_x"]) / 2
        yield near("x at the end", turtle.x, middle, limits["most_x"] - middle, " m")
        yield near("speed at the end", turtle.speed, 0.0, 0.05, " m/s")
