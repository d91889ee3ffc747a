"""A car as a bicycle: a virtual rear wheel and a virtual steering joint move its real ones.

As steer_bot_hardware_gazebo for ackermann_steering_controller, which takes one joint each.
Its steer_bot_hardware_gazebo.cpp gives all four wheels one speed; here the rear ones differ and
the front ones roll, so that the car drives the circle that its odometry computes.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from bullet_sim.control.controllers.mobile_base import read_distance
from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.hardware import RobotHardware, read_joint_limits
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.description import JointLimits
from bullet_sim.errors import check_lengths
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.formats.urdf.transmission import Transmission
from bullet_sim.model import Model

STEEPEST = math.radians(89.0)  # of the virtual joint; at larger angles there is no usable circle


@dataclass(frozen=True)
class SteerBotGeometry:
    """Lengths in m."""

    track: float  # between the steered wheels
    wheelbase: float
    ackermann: bool = True  # else both steered wheels are parallel

    def __post_init__(self):
        check_lengths(self, "track", "wheelbase")

    def angles(self, middle: float) -> tuple[float, float]:
        """Angles of the right and the left wheel (rad), for the angle half-way between them (rad).

        All wheels turn about one point on the rear axle: cot(wheel) = cot(middle) +- track / 2h.
        """
        if not self.ackermann:
            return middle, middle
        slope, part = math.tan(middle), self.track / (2 * self.wheelbase)
        return (math.atan2(slope, 1 + part * slope), math.atan2(slope, 1 - part * slope))

    def shares(self, middle: float) -> tuple[float, float]:
        """Factors of the rear axle's speed for the right and the left wheel, as a differential."""
        if not self.ackermann:
            return 1.0, 1.0
        part = self.track / (2 * self.wheelbase) * math.tan(middle)
        return 1 + part, 1 - part

    def middle(self, right: float, left: float) -> float:
        """The angle half-way between those of both wheels (rad)."""
        if not self.ackermann:
            return (right + left) / 2
        part = self.track / (2 * self.wheelbase)
        return math.fsum((math.atan2(math.tan(right), 1 - part * math.tan(right)),
                          math.atan2(math.tan(left), 1 + part * math.tan(left)))) / 2


class SteerBotHardware(RobotHardware):
    """Virtual joints `rear_wheel` (velocity) and `front_steer` (position), and the real ones."""

    _steer: CommandHandle | None = None  # until the real joints are found

    def __init__(self, model: Model, rear_wheel: str, front_steer: str,
                 rear_wheels: Sequence[str], front_steers: Sequence[str],
                 geometry: SteerBotGeometry, limits: Mapping[str, JointLimits]):
        """`rear_wheels` and `front_steers` are real joints, each the right one before the left.

        SimulationError for a joint that the model does not have, or for impossible limits.
        """
        super().__init__(model, [
            *(Transmission(name, name, "velocity") for name in rear_wheels),
            *(Transmission(name, name, "position") for name in front_steers)], limits, {})
        self._geometry = geometry
        self._rear = [self._handles[name] for name in rear_wheels]
        self._front = [self._handles[name] for name in front_steers]
        self._wheel = self._virtual(rear_wheel, "continuous", "velocity")
        self._steer = self._virtual(front_steer, "revolute", "position")
        self._virtual_read()

    def _virtual(self, name: str, kind: str, interface: str) -> CommandHandle:
        handle = CommandHandle(JointHandle(name, kind), interface)
        self.joints[name], self._handles[name] = handle.joint, handle
        return handle

    def read(self) -> None:
        """Update all joints; the virtual ones are means of the real ones."""
        super().read()
        if self._steer is not None:
            self._virtual_read()

    def _virtual_read(self) -> None:
        wheel, steer = self._wheel.joint, self._steer.joint
        for part in ("position", "velocity", "effort"):
            setattr(wheel, part, sum(getattr(real.joint, part) for real in self._rear) / 2)
        right, left = (real.joint for real in self._front)
        steer.position = self._geometry.middle(right.position, left.position)
        steer.velocity = (right.velocity + left.velocity) / 2

    def write(self, period: float) -> None:
        """Turn the virtual joints' commands into those of the real ones, for the next step."""
        middle = max(-STEEPEST, min(STEEPEST, self._steer.command))
        for real, share in zip(self._rear, self._geometry.shares(middle), strict=True):
            real.command = share * self._wheel.command
        for real, angle in zip(self._front, self._geometry.angles(middle), strict=True):
            real.command = angle
        super().write(period)


def open_steer_bot(model: Model, robot: RobotFacts,
                   parameters: ControllerParameters) -> SteerBotHardware:
    """Reads the parameters of steer_bot_hardware_gazebo.cpp, initSim, or lengths from the URDF.

    PluginError if a parameter is missing or of the wrong type; SimulationError if a joint does not
    exist.
    """
    p = parameters.group("steer_bot_hardware_gazebo")
    wheels, steers = (p.pair(name, "there must be two, the right and the left one")
                      for name in ("virtual_rear_wheels", "virtual_front_steers"))
    geometry = SteerBotGeometry(
        read_distance(p, robot, "wheel_separation_w", steers[0], steers[1], axis=1),
        read_distance(p, robot, "wheel_separation_h", wheels[0], steers[0], axis=0),
        p.flag("enable_ackermann_link", True))
    return SteerBotHardware(
        model, p.text("rear_wheel"), p.text("front_steer"), wheels, steers, geometry,
        read_joint_limits(parameters, robot, [*wheels, *steers]))
