"""Ackermann steering as a bicycle: one driven rear wheel, one steered front wheel."""

import math
from dataclasses import dataclass

from bullet_sim.control.controllers.mobile_base import BaseOptions, MobileBase
from bullet_sim.control.handles import CommandHandle
from bullet_sim.errors import check_lengths


@dataclass(frozen=True)
class AckermannGeometry:
    """Lengths in m, with multipliers applied."""

    wheelbase: float
    wheel_radius: float
    steering_multiplier: float = 1.0  # the odometry's factor on the steering joint's angle

    def __post_init__(self):
        check_lengths(self, "wheelbase", "wheel_radius")


class AckermannSteering(MobileBase):
    """`turning` is the steering angle itself (rad), and its limits apply to that.

    As AckermannSteeringController::update in ackermann_steering_controller.cpp.
    """

    def __init__(self, rear_wheel: CommandHandle, front_steer: CommandHandle,
                 geometry: AckermannGeometry, options: BaseOptions):
        super().__init__(options)
        self._rear_wheel, self._front_steer = rear_wheel, front_steer
        self._geometry = geometry
        self._travelled = 0.0

    def _drive(self, forward: float, turning: float) -> None:
        self._rear_wheel.command = forward / self._geometry.wheel_radius
        self._front_steer.command = turning

    def _moved(self) -> tuple[float, float, float]:
        g, before = self._geometry, self._travelled
        self._travelled = self._rear_wheel.joint.position
        way = (self._travelled - before) * g.wheel_radius
        steering = self._front_steer.joint.position * g.steering_multiplier
        return way, 0.0, way * math.tan(steering) / g.wheelbase

    def _twist(self, forward: float, turning: float) -> tuple[float, float]:
        return forward, forward * math.tan(turning) / self._geometry.wheelbase
