"""Makes a joint of each command interface follow its desired state."""

from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.pid import Pid
from bullet_sim.control.trajectory.segment import Waypoint


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
