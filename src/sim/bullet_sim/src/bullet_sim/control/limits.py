"""Keeps commands within the limits of a joint, as joint_limits_interface does."""

import math
from abc import ABC, abstractmethod
from typing import Protocol

from bullet_sim.description import JointLimits


class JointState(Protocol):
    """The state that limits depend on."""

    position: float
    velocity: float


def clamp(value: float, low: float, high: float) -> float:
    """The nearest number in [low, high]."""
    return low if value < low else high if value > high else value


class Limiter(ABC):
    """Keeps the commands of one joint within limits. `apply` is called once per step."""

    def __init__(self, joint: JointState, limits: JointLimits):
        self._joint = joint
        self._limits = limits
        self.reset()

    def reset(self) -> None:
        """After a reset of the joint, or a stop: forget the previous command."""
        self._last: float | None = None

    @abstractmethod
    def apply(self, command: float, period: float) -> float:
        """The allowed command, `period` (s) after the previous one."""

    def _soft_speeds(self, position: float) -> tuple[float, float]:
        """Minimum and maximum speed at a position, by the soft limits."""
        limits, soft = self._limits, self._limits.soft
        most = limits.velocity
        if not limits.has_position:
            return -most, most
        return (clamp(-soft.k_position * (position - soft.lower), -most, most),
                clamp(-soft.k_position * (position - soft.upper), -most, most))


class EffortLimiter(Limiter):
    """Effort limit; and no effort that leads further out of position or velocity limits."""

    def apply(self, command: float, period: float) -> float:
        """N m or N."""
        limits, joint = self._limits, self._joint
        if limits.soft is not None:
            return self._soft(command)
        low, high = -limits.effort, limits.effort
        if joint.position < limits.lower or joint.velocity < -limits.velocity:
            low = 0.0
        if joint.position > limits.upper or joint.velocity > limits.velocity:
            high = 0.0
        return clamp(command, low, high)

    def _soft(self, command: float) -> float:
        limits, soft, rate = self._limits, self._limits.soft, self._joint.velocity
        slowest, fastest = self._soft_speeds(self._joint.position)
        return clamp(command,
                     clamp(-soft.k_velocity * (rate - slowest), -limits.effort, limits.effort),
                     clamp(-soft.k_velocity * (rate - fastest), -limits.effort, limits.effort))


class PositionLimiter(Limiter):
    """Position limits, and no step that exceeds the velocity limit."""

    def apply(self, command: float, period: float) -> float:
        """rad or m."""
        limits = self._limits
        last = self._joint.position if self._last is None else self._last
        if limits.soft is not None:
            slowest, fastest = self._soft_speeds(last)
        else:
            slowest, fastest = -limits.velocity, limits.velocity
        low = max(last + slowest * period, limits.lower)
        high = min(last + fastest * period, limits.upper)
        self._last = clamp(command, low, high)
        return self._last


class VelocityLimiter(Limiter):
    """Velocity limit, and acceleration limit if there is one."""

    def apply(self, command: float, period: float) -> float:
        """rad/s or m/s."""
        limits = self._limits
        if limits.soft is not None:
            low, high = self._soft_speeds(self._joint.position)
        else:
            low, high = -limits.velocity, limits.velocity
        if limits.acceleration < math.inf:
            last, step = self._last or 0.0, limits.acceleration * period
            low, high = max(low, last - step), min(high, last + step)
        self._last = clamp(command, low, high)
        return self._last


LIMITERS = {"effort": EffortLimiter, "position": PositionLimiter, "velocity": VelocityLimiter}
