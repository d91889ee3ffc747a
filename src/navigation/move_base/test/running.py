"""What the stories ask of running nodes and of processes, and how they wait."""

from __future__ import annotations

import time
import xmlrpc.client
from collections.abc import Callable
from typing import Any

import numpy as np
import rosgraph
import rospy
from move_base_msgs.msg import MoveBaseGoal

from nav_nodes.messages import stamped_pose


def wait_until(condition: Callable[[], Any], what: str, limit: float = 60.0) -> Any:
    """The condition's first true value."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.02)
    raise AssertionError(f"not within {limit} s: {what}")


def goal_at(place: tuple[float, float, float], frame: str = "map") -> MoveBaseGoal:
    """A goal of the action, m and rad."""
    return MoveBaseGoal(stamped_pose(np.array(place), frame, rospy.Time.now()))


def address(node: str) -> str | None:
    """Where a node answers; None while the master knows none of that name that does."""
    try:
        found = rosgraph.Master("/story").lookupNode(f"/{node}")
        xmlrpc.client.ServerProxy(found).getPid("/story")
        return found
    except (rosgraph.MasterException, OSError):
        return None


def sends_to_us(node: str, topics: set[str]) -> bool:
    """Whether it has made its side of the links, too: a subscriber may count one before that."""
    links = xmlrpc.client.ServerProxy(address(node)).getBusInfo("/story")[2]
    return topics <= {topic for _, caller, direction, _, topic, is_open, *_ in links
                      if direction == "o" and is_open and caller == rospy.get_name()}


def pid_of(node: str) -> int:
    """The process of a node that answers."""
    return xmlrpc.client.ServerProxy(address(node)).getPid("/story")[2]


def alive(process: int) -> bool:
    """Whether a process runs that is not ours."""
    try:
        with open(f"/proc/{process}/stat", encoding="utf-8") as stat:
            return stat.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False
