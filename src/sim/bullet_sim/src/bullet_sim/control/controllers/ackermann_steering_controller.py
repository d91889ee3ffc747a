"""Ackermann steering as a bicycle: one driven rear wheel, one steered front wheel."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bullet_sim.control.controllers.mobile_base import (
    BaseOptions,
    Claim,
    MobileBase,
    read_distance,
    read_wheel_radius,
)
from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.errors import check_lengths
from bullet_sim.formats.urdf.facts import RobotFacts


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

    @classmethod
    def from_parameters(cls, p: ControllerParameters, robot: RobotFacts, claim: Claim
                        ) -> AckermannSteering:
        """Of ackermann_steering_controller.

        PluginError for a parameter that is wrong, SimulationError for a length that is not above 0.
        """
        rear = p.text("rear_wheel", "rear_wheel_joint")
        front = p.text("front_steer", "front_steer_joint")
        handles = claim("velocity", rear), claim("position", front)
        wheelbase = read_distance(p, robot, "wheel_separation_h", rear, front)
        radius = read_wheel_radius(p, robot, rear)
        return cls(*handles, AckermannGeometry(
            wheelbase * p.number("wheel_separation_h_multiplier", 1.0),
            radius * p.number("wheel_radius_multiplier", 1.0),
            p.number("steer_pos_multiplier", 1.0)), BaseOptions.from_parameters(p))

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
