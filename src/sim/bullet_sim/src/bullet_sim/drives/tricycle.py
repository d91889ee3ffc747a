"""Tricycle drive: one wheel that is steered and driven, two that only roll."""

import math
from dataclasses import dataclass

from bullet_sim.errors import SimulationError
from bullet_sim.joint import Joint

GREATEST_ANGLE = math.pi / 2  # rad, of the steering
PLACED = 1e-4  # rad: a joint closer to its angle than this is not reset again


@dataclass(frozen=True)
class TricycleParameters:
    """Geometry and motors; defaults are those of gazebo_ros_tricycle_drive."""

    wheel_diameter: float = 0.15  # m, of the driven wheel
    torque: float = 5.0  # N m, of the driven wheel and the steering
    acceleration: float = 0.0  # rad/s^2 of the wheel; 0: immediate
    deceleration: float = 0.0  # rad/s^2 of the wheel
    speed_tolerance: float = 0.01  # rad/s: closer to the target than this, the command jumps to it
    steering_speed: float = 0.0  # rad/s; 0: the joint is reset to its angle
    angle_tolerance: float = 0.01  # rad: closer to the target than this, the steering stops


class Tricycle:
    """Turns (wheel speed, steering angle) into motor targets; `update` at the drive's own rate.

    SimulationError for a diameter that is not above 0.
    """

    def __init__(self, steering: Joint, wheel: Joint, parameters: TricycleParameters):
        if parameters.wheel_diameter <= 0:
            raise SimulationError(
                f"the driven wheel's diameter {parameters.wheel_diameter} must be more than 0 m")
        self._steering, self._wheel = steering, wheel
        self._parameters = parameters
        self.stop()

    def command(self, speed: float, angle: float) -> None:
        """Set the rim speed of the driven wheel (m/s) and the steering angle (rad)."""
        self._rate = speed / (self._parameters.wheel_diameter / 2)
        self._angle = max(-GREATEST_ANGLE, min(GREATEST_ANGLE, angle))

    def stop(self) -> None:
        """Forget command and ramp."""
        self._rate = self._angle = self._commanded = 0.0

    def update(self, elapsed: float) -> None:
        """Move the motor targets towards the command; `elapsed` in s since the last update."""
        p = self._parameters
        if p.acceleration > 0:
            self._commanded = self._ramped(elapsed)
        else:
            self._commanded = self._rate
        self._wheel.drive_velocity(self._commanded, p.torque)
        self._steer()

    def _ramped(self, elapsed: float) -> float:
        p, now = self._parameters, self._commanded
        gap = self._rate - now
        if abs(gap) < p.speed_tolerance:
            return self._rate
        faster = abs(self._rate) > abs(now)
        step = (p.acceleration if faster else p.deceleration) * elapsed
        return now + max(-step, min(step, gap))

    def _steer(self) -> None:
        p, joint = self._parameters, self._steering
        gap = self._angle - joint.position
        if p.steering_speed > 0:
            turning = abs(gap) >= p.angle_tolerance
            rate = math.copysign(p.steering_speed, gap) if turning else 0.0
            joint.drive_velocity(rate, p.torque)
            return
        joint.drive_velocity(0.0, p.torque)
        if abs(gap) > PLACED:
            joint.reset(self._angle)
