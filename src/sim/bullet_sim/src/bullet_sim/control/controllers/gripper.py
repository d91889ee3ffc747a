"""A gripper with one joint: moves to a position, and detects arrival and stalling."""

from collections.abc import Callable
from dataclasses import dataclass

from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.pid import Pid


@dataclass(frozen=True)
class GripperOptions:
    """Defaults of gripper_action_controller_impl.h, GripperActionController::init."""

    goal_tolerance: float = 0.01  # rad or m
    max_effort: float = 0.0  # N m or N, if a goal gives none
    stall_velocity_threshold: float = 0.001  # rad/s or m/s; slower counts as standing
    stall_timeout: float = 1.0  # s


@dataclass(frozen=True)
class GripperState:
    """Feedback and result of a goal."""

    position: float  # rad or m
    effort: float  # N m or N, as commanded
    stalled: bool = False
    reached_goal: bool = False


# Moves the joint: takes position, maximum effort and period (s); returns the commanded effort.
Move = Callable[[float, float, float], float]


def move_by_position(handle: CommandHandle) -> Move:
    """Commands the position; reports the maximum effort."""
    def move(position: float, max_effort: float, period: float) -> float:
        handle.command = position
        return max_effort
    return move


def move_by_effort(handle: CommandHandle, pid: Pid) -> Move:
    """A PID on the position, limited to the maximum effort."""
    def move(position: float, max_effort: float, period: float) -> float:
        joint, bound = handle.joint, abs(max_effort)
        effort = pid.compute(position - joint.position, period, -joint.velocity)
        handle.command = max(-bound, min(bound, effort))
        return handle.command
    return move


class Gripper:
    """Call `update` each control period; it returns the outcome of a goal."""

    def __init__(self, handle: CommandHandle, move: Move, options: GripperOptions):
        self._joint = handle.joint
        self._move = move
        self._options = options
        self._moved = 0.0  # s, time of the last movement
        self._pursuing = False
        self.effort = 0.0
        self.hold()

    def start(self, time: float) -> None:
        """Hold the current position."""
        self._moved = time
        self.hold()

    def hold(self) -> None:
        """Hold the current position and drop the goal."""
        self._pursuing = False
        self._position, self._max_effort = self._joint.position, self._options.max_effort

    def pursue(self, time: float, position: float, max_effort: float) -> None:
        """Pursue a goal: rad or m, and the maximum effort."""
        self._pursuing, self._moved = True, time
        self._position, self._max_effort = position, max_effort

    def state(self, stalled: bool = False, reached_goal: bool = False) -> GripperState:
        """The current state."""
        return GripperState(self._joint.position, self.effort, stalled, reached_goal)

    def update(self, time: float, period: float) -> GripperState | None:
        """Run one control period; returns the result when the goal is reached or the joint stalls.

        The position is still held afterwards.
        """
        outcome = self._judge(time) if self._pursuing else None
        self._pursuing = self._pursuing and outcome is None
        self.effort = self._move(self._position, self._max_effort, period)
        return outcome

    def _judge(self, time: float) -> GripperState | None:
        if abs(self._position - self._joint.position) < self._options.goal_tolerance:
            return self.state(reached_goal=True)
        if abs(self._joint.velocity) > self._options.stall_velocity_threshold or time < self._moved:
            self._moved = time
        elif time - self._moved > self._options.stall_timeout:
            return self.state(stalled=True)
        return None
