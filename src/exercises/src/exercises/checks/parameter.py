"""A private parameter that may change at any time: `speed` of a node that drives a turtle."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import rospy
from geometry_msgs.msg import Twist

from exercises.errors import Mistake
from exercises.finding import Finding, near
from exercises.node import START, running

TOPIC, NAME = "/turtle1/cmd_vel", "speed"
TOLERANCE = 0.001  # m/s


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """Its speed must be the default, then the value set while it drives, then the default again."""
    with running(file) as until:
        commands: list[Twist] = []
        rospy.Subscriber(TOPIC, Twist, commands.append, queue_size=10)
        if not until(lambda: commands, START):
            raise Mistake(f"{file}: publishes nothing on {TOPIC}")
        parameter = f"{commands[0]._connection_header['callerid']}/{NAME}"

        def driven(when: str, wanted: float) -> Finding:
            until(lambda: abs(commands[-1].linear.x - wanted) < TOLERANCE, limits["seconds"])
            return near(f"commanded speed ({when})", commands[-1].linear.x, wanted, TOLERANCE,
                        " m/s")

        yield driven("before anybody has set it", limits["default"])
        rospy.set_param(parameter, limits["other"])
        yield driven(f"after rosparam set {parameter} {limits['other']:g}", limits["other"])
        rospy.delete_param(parameter)
        yield driven(f"after rosparam delete {parameter}", limits["default"])
