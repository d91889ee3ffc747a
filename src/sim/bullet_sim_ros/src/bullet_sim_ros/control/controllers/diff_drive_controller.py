"""diff_drive_controller: wheels on two sides, driven by a twist."""

import math
from collections.abc import Mapping

from control_msgs.msg import JointTrajectoryControllerState
from geometry_msgs.msg import TwistStamped
from trajectory_msgs.msg import JointTrajectoryPoint

from bullet_sim.control.controllers.diff_drive_controller import DiffDriveLaw
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.controllers.mobile_bases import MobileBaseController
from bullet_sim_ros.control.registry import controller
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.reconfigure_server import Value, offer_values

MULTIPLIERS = (0.5, 1.5)
RATES = (0.0, 2000.0)  # Hz


@controller("diff_drive_controller/DiffDriveController")
class DiffDriveController(MobileBaseController):
    """Multipliers of separation and radii can be changed by dynamic_reconfigure."""

    law = DiffDriveLaw

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        p = context.parameters
        self._limited = context.advertise("cmd_vel_out", TwistStamped, queue_size=100) if p.flag(
            "publish_cmd", False) else None
        self._wheels = WheelStates(context, self.base) if p.flag(
            "publish_wheel_joint_controller_state", False) else None
        self._offer_changes()

    def update(self, time: float, period: float) -> None:
        """Drive; also publish the limited command and the wheels' state.

        As in diff_drive_controller.cpp, DiffDriveController::update.
        """
        super().update(time, period)
        if self._limited and self._limited.get_num_connections():
            msg = TwistStamped()
            convert.stamped(msg, time)
            msg.twist.linear.x, msg.twist.angular.z = self.base.limited
            self._limited.publish(msg)
        if self._wheels:
            self._wheels.update(time, period)

    def _offer_changes(self) -> None:
        """Offer dynamic_reconfigure, with names and ranges of DiffDriveController.cfg."""
        context = self.context
        values = {name: Value(now, *MULTIPLIERS, name.replace("_", " "))
                  for name, now in self.base.multipliers.items()}
        values["publish_rate"] = Value(context.parameters.number("publish_rate", 50.0), *RATES,
                                       "odometry and transforms a second")
        values["enable_odom_tf"] = Value(
            context.parameters.flag("enable_odom_tf", True), False, True, "publish the transform")
        offer_values(context, context.namespace, values,
                     lambda new: context.mailbox.post(
                         lambda: self._change(new), Input(context.namespace, None)))

    def _change(self, values: Mapping[str, float | bool]) -> None:
        self.base.multiply({name: values[name] for name in self.base.multipliers})
        self.odometry.set_transform(values["enable_odom_tf"])
        self.set_publish_rate(values["publish_rate"])


class WheelStates:
    """Publishes desired and actual state and their difference for each wheel, left ones first."""

    def __init__(self, context: ControllerContext, drive: DiffDriveLaw):
        self._drive = drive
        self._handles = (*drive.left, *drive.right)
        self._topic = context.advertise("wheel_joint_controller_state",
                                        JointTrajectoryControllerState, queue_size=100)
        count = len(self._handles)
        self._positions, self._wanted, self._actual = [0.0] * count, [0.0] * count, [0.0] * count

    def update(self, time: float, period: float) -> None:
        """To be called after each update of the drive; desired speeds are those before limits."""
        left, right = self._drive.wheel_speeds(*self._drive.wanted)
        wanted = [left] * len(self._drive.left) + [right] * len(self._drive.right)
        actual = [handle.joint.velocity for handle in self._handles]
        self._positions = [position + speed * period for position, speed in zip(
            self._positions, wanted, strict=True)]
        if self._topic.get_num_connections():
            self._topic.publish(self._message(time, wanted, actual, period))
        self._wanted, self._actual = wanted, actual

    def _message(self, time: float, wanted: list[float], actual: list[float],
                 period: float) -> JointTrajectoryControllerState:
        joints = [handle.joint for handle in self._handles]
        msg = JointTrajectoryControllerState(joint_names=[joint.name for joint in joints])
        convert.stamped(msg, time)
        msg.desired = JointTrajectoryPoint(
            positions=self._positions, velocities=wanted,
            accelerations=_rates(wanted, self._wanted, period), effort=[math.nan] * len(joints))
        msg.actual = JointTrajectoryPoint(
            positions=[joint.position for joint in joints], velocities=actual,
            accelerations=_rates(actual, self._actual, period),
            effort=[joint.effort for joint in joints])
        msg.error = JointTrajectoryPoint(**{
            name: _differences(getattr(msg.desired, name), getattr(msg.actual, name))
            for name in ("positions", "velocities", "accelerations", "effort")})
        return msg


def _rates(now: list[float], before: list[float], period: float) -> list[float]:
    return [difference / period for difference in _differences(now, before)] if period else now


def _differences(first: list[float], second: list[float]) -> list[float]:
    return [a - b for a, b in zip(first, second, strict=True)]
