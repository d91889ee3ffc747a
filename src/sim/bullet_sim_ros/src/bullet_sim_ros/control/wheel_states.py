"""Topic wheel_joint_controller_state: what a base's wheels are to do, and do."""

import math

from control_msgs.msg import JointTrajectoryControllerState
from trajectory_msgs.msg import JointTrajectoryPoint

from bullet_sim.control.controllers.diff_drive_controller import DiffDrive
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext


class WheelStates:
    """Wanted, actual and the difference of both, wheel by wheel, the left ones first."""

    def __init__(self, context: ControllerContext, drive: DiffDrive):
        self._drive = drive
        self._handles = (*drive.left, *drive.right)
        self._topic = context.advertise("wheel_joint_controller_state",
                                        JointTrajectoryControllerState, queue_size=100)
        count = len(self._handles)
        self._positions, self._wanted, self._actual = [0.0] * count, [0.0] * count, [0.0] * count

    def update(self, time: float, period: float) -> None:
        """After each update of the drive; what is wanted is so before the limits."""
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
