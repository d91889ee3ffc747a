"""An action server that aborts unsuitable goals: addInts, learning_action/AddInts."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import actionlib
import rospy
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from learning_action.msg import AddIntsAction, AddIntsGoal

from exercises.errors import Mistake
from exercises.finding import Finding, holds
from exercises.node import START, running

NAME = "addInts"
BESIDE = -3, -1, 0, 3  # test goals, relative to the least valid one


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """Goals that are too small must be aborted, all others succeed with their sum."""
    least = round(limits["least"])
    with running(file) as until:
        # Not SimpleActionClient: it misses a result that comes before its send_goal() has returned.
        client = actionlib.ActionClient(NAME, AddIntsAction)
        if not until(lambda: client.wait_for_server(rospy.Duration(0.1)), START):
            raise Mistake(f"{file}: offers no action {NAME} of type learning_action/AddInts")
        for number in (least + beside for beside in BESIDE):
            sent = client.send_goal(AddIntsGoal(num=number))
            ended = until(lambda handle=sent: handle.get_comm_state() == CommState.DONE,
                          limits["seconds"])
            state = GoalStatus.to_string(sent.get_goal_status()) if ended else "none"
            if number >= least:
                total = sum(range(1, number + 1))
                given = getattr(sent.get_result(), "result", None)
                yield holds(f"sum for the goal {number}", str(given), str(total), given == total)
            wanted = "SUCCEEDED" if number >= least else "ABORTED"
            yield holds(f"end of the goal {number}", state, wanted, state == wanted)
