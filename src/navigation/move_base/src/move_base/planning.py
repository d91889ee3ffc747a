"""The planner thread, which runs besides the one that drives."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped

from move_base.state_machine import State, StateMachine

SLICE = 0.02  # s of wall time between two checks of the clock


class CannotPlanYet(Exception):
    """The robot's pose is unknown, which is not a failure of the planner."""


class Planning:
    """Plans for one goal, whenever the state machine wants it, and keeps the newest path."""

    def __init__(self, machine: StateMachine, plan: Callable[[PoseStamped], np.ndarray | None],
                 pause_after_failure: Callable[[], float]) -> None:
        """`plan` may raise CannotPlanYet; unlike upstream's planner, it pauses after a failure."""
        self._machine, self._plan, self._pause = machine, plan, pause_after_failure
        self._condition = threading.Condition()
        self._number, self._goal = 0, None
        self._path: np.ndarray | None = None
        threading.Thread(target=self._run, name="planner", daemon=True).start()

    def begin(self, number: int, goal: PoseStamped) -> None:
        """Plan for this goal, which has the state machine's number."""
        with self._condition:
            self._number, self._goal, self._path = number, goal, None
            self._condition.notify_all()

    def take_path(self) -> np.ndarray | None:
        """The path (N, 3) planned since the last call, if any."""
        with self._condition:
            path, self._path = self._path, None
            return path

    def _run(self) -> None:
        while not rospy.is_shutdown():
            with self._condition:
                if self._goal is None or not self._machine.wants_plan:
                    self._condition.wait(SLICE)
                    continue
                number, goal = self._number, self._goal
            began = rospy.get_time()
            try:
                path = self._plan(goal)
            except CannotPlanYet:
                self._rest(number, began, self._pause())
                continue
            except Exception:  # an error counts as no path; this thread must go on
                rospy.logerr_throttle(5.0, "The global planner failed: " + traceback.format_exc())
                path = None
            with self._condition:
                if number == self._number and path is not None:
                    self._path = path
            self._machine.planned(number, path is not None, rospy.get_time())
            self._rest(number, began, self._period(path is not None))

    def _period(self, found: bool) -> float:
        frequency = self._machine.patience.planner_frequency
        return 1.0 / frequency if found and frequency > 0.0 else self._pause()

    def _rest(self, number: int, began: float, period: float) -> None:
        """Wait until `period`, s, after `began`, or a new goal, or a new demand for a plan."""
        first = self._machine.state
        with self._condition:
            while (began <= rospy.get_time() < began + period and number == self._number
                   and not (self._machine.state is State.PLANNING is not first)
                   and not rospy.is_shutdown()):
                self._condition.wait(SLICE)
