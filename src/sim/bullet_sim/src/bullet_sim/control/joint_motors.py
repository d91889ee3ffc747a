"""Turns a command into the effort or motion of a simulated joint: one class for each method.

The methods, and when each is used, are those of gazebo_ros_control's default_robot_hw_sim.cpp.
"""

from dataclasses import replace

from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.limits import LIMITERS, clamp
from bullet_sim.control.pid import Pid, PidGains
from bullet_sim.description import JointLimits
from bullet_sim.joint import Joint
from bullet_sim.pose import shortest_angular_distance

STRONGEST = 1e6  # N m or N, if there is no limit; much more becomes NaN in the engine
ARRIVED = 1e-9  # rad or m


class JointMotor:
    """Turns a joint's command, within its limits, into settings of the engine."""

    def __init__(self, handle: CommandHandle, limits: JointLimits):
        self.handle = handle
        self.limiter = LIMITERS[handle.interface](handle.joint, limits)
        self._limits = limits

    def reset(self) -> None:
        """Called after a reset of the joint."""
        self.limiter.reset()


class EffortMotor(JointMotor):
    """Applies the commanded effort in each step."""

    def effort(self, period: float) -> float:
        """N m or N, for the next step of `period` (s); also set in the joint's handle."""
        effort = self.limiter.apply(self.handle.command, period)
        self.handle.joint.effort = effort
        return effort


class PidMotor(EffortMotor):
    """A position or velocity command with gains: a PID turns the error into an effort."""

    def __init__(self, handle: CommandHandle, limits: JointLimits, gains: PidGains):
        super().__init__(handle, limits)
        self.pid = Pid(gains)

    def effort(self, period: float) -> float:
        """N m or N, within the effort limit."""
        target = self.limiter.apply(self.handle.command, period)
        joint = self.handle.joint
        if self.handle.interface == "velocity":
            error = target - joint.velocity
        else:
            error = position_error(joint, target)
        most = self._limits.effort
        effort = clamp(self.pid.compute(error, period), -most, most)
        joint.effort = effort
        return effort

    def reset(self) -> None:
        """Called after a reset of the joint."""
        super().reset()
        self.pid.reset()


class VelocityMotor(JointMotor):
    """A velocity command without gains: a motor with the effort limit as its maximum."""

    def __init__(self, handle: CommandHandle, limits: JointLimits, joint: Joint):
        super().__init__(handle, limits)
        self._joint = joint

    def drive(self, period: float) -> None:
        """Set the motor for the next step of `period` (s)."""
        rate = self.limiter.apply(self.handle.command, period)
        self._joint.drive_velocity(rate, self._limits.effort)


class PositionMotor(VelocityMotor):
    """A position command without gains: the joint is there at the end of the next step.

    default_robot_hw_sim.cpp, writeSim, sets the position regardless of forces; here the joint moves
    there, at the velocity limit at most, with a motor that nothing can hold: its velocity is real
    and moves what it carries.
    """

    def drive(self, period: float) -> None:
        """Set the motor for the next step of `period` (s)."""
        target = self.limiter.apply(self.handle.command, period)
        gap = target - self.handle.joint.position
        rate = 0.0 if -ARRIVED < gap < ARRIVED else gap / period
        fastest = self._limits.velocity
        self._joint.drive_velocity(clamp(rate, -fastest, fastest), STRONGEST)


def position_error(joint: JointHandle, target: float) -> float:
    """The error from the joint to the target: a continuous joint turns the shorter way round.

    A revolute one only has the direct way, as long as both are within its limits.
    """
    if joint.type == "continuous":
        return shortest_angular_distance(joint.position, target)
    return target - joint.position


def make_motor(handle: CommandHandle, gains: PidGains | None,
               joint: Joint) -> JointMotor:
    """The motor for a joint's interface, with or without gains."""
    limits = handle.joint.limits
    limits = replace(limits, effort=min(limits.effort, STRONGEST))
    if handle.interface == "effort":
        return EffortMotor(handle, limits)
    if gains is not None:
        return PidMotor(handle, limits, gains)
    kind = PositionMotor if handle.interface == "position" else VelocityMotor
    return kind(handle, limits, joint)
