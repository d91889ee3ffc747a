"""The last command of a node that is ended by Ctrl-C."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from geometry_msgs.msg import Twist

from exercises.errors import Mistake
from exercises.finding import Finding, holds
from exercises.node import START, running

TOPIC = "/turtle1/cmd_vel"


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The turtle must drive, and stop after Ctrl-C."""
    with running(file) as until:
        commands: list[Twist] = []
        rospy.Subscriber(TOPIC, Twist, commands.append, queue_size=10)
        drives = until(lambda: any(command.linear.x for command in commands), START)
        yield holds("the turtle", "drives" if drives else "stands", "drives", drives)
        if not commands:
            raise Mistake(f"{file}: publishes nothing on {TOPIC}")
        try:
            os.kill(_process(commands[0]._connection_header["callerid"]), signal.SIGINT)
        except (rosgraph.MasterError, OSError):  # it is just ending by itself
            until(lambda: False, START)
        time.sleep(limits["seconds"])
        last = commands[-1].linear.x, commands[-1].angular.z
        yield holds("the last command after Ctrl-C", f"{last[0]:g} m/s, {last[1]:g} rad/s",
                    "0 m/s, 0 rad/s", last == (0.0, 0.0))


def _process(node: str) -> int:
    caller = rospy.get_name()
    return ServerProxy(rosgraph.Master(caller).lookupNode(node)).getPid(caller)[2]
