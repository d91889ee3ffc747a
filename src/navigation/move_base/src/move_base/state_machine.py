"""Decides what move_base does next: plan, drive, or recover; upstream's rules, without ROS.

Times are seconds of one clock that the caller reads. All methods may be called on any thread.
"""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass
from enum import Enum

GOAL_REACHED = "Goal reached."


class State(Enum):
    """What the robot is doing or waiting for."""

    PLANNING = "planning"
    CONTROLLING = "controlling"
    CLEARING = "clearing"


class Trigger(Enum):
    """Why recovery was begun; the value is the action's terminal text if nothing helped."""

    PLANNING = "Failed to find a valid plan. Even after executing recovery behaviors."
    CONTROLLING = "Failed to find a valid control. Even after executing recovery behaviors."
    OSCILLATION = "Robot is oscillating. Even after executing recovery behaviors."


@dataclass(frozen=True)
class Patience:
    """move_base's parameters of these names; s, m. A negative number of retries means no limit.

    `progress_timeout` is ours; 0 means none, as in upstream.
    """

    planner_frequency: float
    planner_patience: float
    controller_patience: float
    max_planning_retries: int
    oscillation_timeout: float
    oscillation_distance: float
    progress_timeout: float
    recovery_behavior_enabled: bool


class StateMachine:
    """One goal at a time. `wants_plan` tells the planner to plan, `state` the driver what to do.

    `recovery`, upstream's recovery_index_, is the index of the behaviour to try next.
    """

    def __init__(self, patience: Patience, recoveries: int = 0) -> None:
        """`recoveries`: how many behaviours there are. Both may be replaced at any time."""
        self.patience, self.recoveries = patience, recoveries
        self._lock = threading.RLock()
        self._goal = 0
        self._moved_from: tuple[float, float] | None = None
        self._reset()

    def _reset(self) -> None:
        self.state, self.trigger, self.recovery = State.PLANNING, Trigger.PLANNING, 0
        self.wants_plan, self._retries = False, 0
        self._last_plan = self._last_control = self._last_moved = self._last_nearer = 0.0

    def begin(self, now: float) -> int:
        """Begin a new goal, which may replace another; returns the number that marks its plans."""
        with self._lock:
            self._reset()
            self._goal += 1
            self.wants_plan, self._moved_from = True, None
            self.hold(now)
            return self._goal

    def end(self) -> None:
        """End the goal: plans that still come are ignored."""
        with self._lock:
            self._reset()
            self._goal += 1

    def is_for(self, goal: int) -> bool:
        """Whether this is still the number of the goal."""
        return goal == self._goal

    def hold(self, now: float) -> None:
        """Restart all timeouts: sensor data is missing, or time went back."""
        with self._lock:
            self._last_plan = self._last_control = self._last_moved = self._last_nearer = now

    def at(self, x: float, y: float, now: float) -> None:
        """Take the robot's position, m: while it moves far enough, it does not oscillate."""
        with self._lock:
            moved = (math.inf if self._moved_from is None
                     else math.hypot(x - self._moved_from[0], y - self._moved_from[1]))
            if moved >= self.patience.oscillation_distance:
                self._moved_from, self._last_moved = (x, y), now
                if self.trigger is Trigger.OSCILLATION:
                    self.recovery = 0

    def planned(self, goal: int, found: bool, now: float) -> None:
        """Take the planner's result for the goal of that number."""
        with self._lock:
            if not self.is_for(goal) or not self.wants_plan:
                return
            if found:
                self._last_plan, self._retries = now, 0
                self.state = State.CONTROLLING
                self.wants_plan = self.patience.planner_frequency > 0.0
            elif self.state is State.PLANNING:
                self._retries += 1
                most = self.patience.max_planning_retries
                if now > self._last_plan + self.patience.planner_patience or (
                        0 <= most < self._retries):
                    self._clear(Trigger.PLANNING)

    def took_path(self) -> None:
        """The driver follows a new path, so a planning problem is over."""
        with self._lock:
            if self.trigger is Trigger.PLANNING:
                self.recovery = 0

    def oscillates(self, now: float) -> bool:
        """While driving: whether the robot got nowhere for too long, and now must recover."""
        with self._lock:
            limit = self.patience.oscillation_timeout
            if not 0.0 < limit < now - self._last_moved:
                return False
            self._clear(Trigger.OSCILLATION)
            return True

    def controlled(self, found: bool, nearer: bool, now: float) -> None:
        """Take whether the local planner found a velocity, and whether the robot came nearer."""
        with self._lock:
            patience = self.patience.controller_patience
            if nearer:
                self._last_nearer = now
                if self.trigger is Trigger.CONTROLLING:
                    self.recovery = 0
            if found:
                self._last_control = now
                if 0.0 < self.patience.progress_timeout < now - self._last_nearer:
                    self._clear(Trigger.CONTROLLING)
            elif now > self._last_control + patience:
                self._clear(Trigger.CONTROLLING)
            else:
                self._plan_again(now)

    def failure(self) -> str | None:
        """While clearing: the action's terminal text, if no behaviour is left to try."""
        with self._lock:
            left = self.patience.recovery_behavior_enabled and self.recovery < self.recoveries
            return None if left else self.trigger.value

    def recovered(self, now: float) -> None:
        """A behaviour has ended; planning will show whether it helped."""
        with self._lock:
            self._last_moved = self._last_nearer = now
            self.recovery += 1
            self._plan_again(now)

    def _plan_again(self, now: float) -> None:
        self._last_plan, self._retries = now, 0
        self.state, self.wants_plan = State.PLANNING, True

    def _clear(self, trigger: Trigger) -> None:
        """Start recovery without planning; upstream plans on, and a plan may end recovery early."""
        self.state, self.trigger, self.wants_plan = State.CLEARING, trigger, False
