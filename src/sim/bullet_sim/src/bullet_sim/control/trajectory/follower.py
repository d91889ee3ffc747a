"""Follows a trajectory with some joints, and evaluates its goal."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.pid import Pid
from bullet_sim.control.trajectory.path import Waypoint, stopping
from bullet_sim.control.trajectory.request import (
    GoalTolerances,
    Tolerance,
    TrajectoryRequest,
    check,
    join,
)


class PositionDrive:
    """Commands the desired position."""

    def __init__(self, handle: CommandHandle):
        self._handle = handle

    def restart(self) -> None:
        """Hold the current position."""
        self._handle.rest()

    def __call__(self, desired: Waypoint, error: Waypoint, period: float) -> None:
        self._handle.command = desired.position


class PidDrive:
    """Feed-forward of the desired velocity, and a PID on the errors of position and velocity."""

    def __init__(self, handle: CommandHandle, pid: Pid, velocity_ff: float = 0.0):
        self._handle = handle
        self._pid = pid
        self._velocity_ff = velocity_ff  # command per rad/s or m/s

    def restart(self) -> None:
        """Forget past errors."""
        self._pid.reset()
        self._handle.rest()

    def __call__(self, desired: Waypoint, error: Waypoint, period: float) -> None:
        feedback = self._pid.compute(error.position, period, error.velocity)
        self._handle.command = desired.velocity * self._velocity_ff + feedback


# Writes one joint's command: takes its desired state, its error, and the period (s).
Drive = Callable[[Waypoint, Waypoint, float], None]


class Verdict(Enum):
    """How a goal ended."""

    REACHED = "reached"
    LEFT_PATH = "left the path"
    MISSED_GOAL = "missed the goal"


@dataclass(frozen=True)
class Outcome:
    """The end of a goal."""

    verdict: Verdict
    text: str = ""


@dataclass(frozen=True)
class _Goal:
    """The checks of a goal, by the index of the joint."""

    begins: float  # s
    path: dict[int, Tolerance]
    end: dict[int, Tolerance]
    time: float  # s


class TrajectoryFollower:
    """Its time is its own uptime, which a reset of the world does not change."""

    def __init__(self, joints: Sequence[JointHandle], drives: Sequence[Drive],
                 stop_duration: float = 0.0, partial: bool = False):
        self.joints = tuple(joints)
        self.names = [joint.name for joint in joints]
        self.desired: list[Waypoint] = []
        self.actual: list[Waypoint] = []
        self.error: list[Waypoint] = []
        self._drives = tuple(drives)
        self._continuous = [joint.type == "continuous" for joint in joints]
        self._stop_duration = stop_duration
        self._partial = partial
        self._uptime = self._period = self._time = 0.0
        self._goal: _Goal | None = None
        self.hold()
        self._compare()

    def start(self, time: float) -> None:
        """Hold still from now on."""
        self._uptime, self._time = 0.0, time
        self.hold()

    def hold(self) -> None:
        """Come to rest; drop the goal."""
        self._goal = None
        self._paths = [stopping(self._uptime, joint.position, joint.velocity, self._stop_duration)
                       for joint in self.joints]

    def follow(self, request: TrajectoryRequest, tolerances: GoalTolerances | None = None) -> None:
        """Replace the trajectory; an InvalidTrajectory leaves everything as it is.

        With tolerances the request is a goal, and `update` returns its outcome. Without points the
        joints hold still.
        """
        if request.points or tolerances:
            check(request, self.names, self._partial)
        now = begins = self._uptime + self._period  # of the next update
        if request.points:
            start = now if request.start is None else self._own_time(request.start)
            request = TrajectoryRequest(request.joints, request.points, start)
            self._paths = join(request, self.names, self._continuous, self._paths, now)
            begins = max(start, now)
        else:
            self.hold()
        self._goal = self._to_judge(request.joints, tolerances, begins) if tolerances else None

    def _to_judge(self, joints: Sequence[str], tolerances: GoalTolerances, begins: float) -> _Goal:
        chosen = [(self.names.index(name), name) for name in joints]
        return _Goal(begins,
                     {index: tolerances.path.get(name, Tolerance()) for index, name in chosen},
                     {index: tolerances.goal.get(name, Tolerance()) for index, name in chosen},
                     tolerances.time)

    def update(self, time: float, period: float) -> Outcome | None:
        """Run one control period; returns the goal's outcome when it is over."""
        self._time, self._period = time, period
        self._uptime += period
        self._compare()
        outcome = self._judge()
        for drive, desired, error in zip(self._drives, self.desired, self.error, strict=True):
            drive(desired, error, period)
        return outcome

    def sample(self, time: float) -> list[Waypoint]:
        """The desired states at a simulated time (s)."""
        own = self._own_time(time)
        return [path.sample(own) for path in self._paths]

    def _own_time(self, time: float) -> float:
        return self._uptime + (time - self._time)

    def _compare(self) -> None:
        self.desired = [path.sample(self._uptime) for path in self._paths]
        self.actual = [Waypoint(joint.position, joint.velocity) for joint in self.joints]
        self.error = [Waypoint(wanted.position - joint.position, wanted.velocity - joint.velocity)
                      for wanted, joint in zip(self.desired, self.joints, strict=True)]

    def _judge(self) -> Outcome | None:
        goal = self._goal
        if goal is None or self._uptime < goal.begins:
            return None
        outcome = self._judge_path(goal) or self._judge_end(goal)
        if outcome:
            self._goal = None
        return outcome

    def _judge_path(self, goal: _Goal) -> Outcome | None:
        for index, tolerance in goal.path.items():
            violation = tolerance.violation(self.error[index])
            if violation and self._uptime < self._paths[index].end_time:
                return Outcome(Verdict.LEFT_PATH, f"{self.names[index]}: path {violation}")
        return None

    def _judge_end(self, goal: _Goal) -> Outcome | None:
        ends = max(self._paths[index].end_time for index in goal.end)
        if self._uptime < ends:
            return None
        for index, tolerance in goal.end.items():
            violation = tolerance.violation(self.error[index])
            if violation and self._uptime < ends + goal.time:
                return None
            if violation:
                return Outcome(Verdict.MISSED_GOAL, f"{self.names[index]}: goal {violation}")
        return Outcome(Verdict.REACHED)
