"""Pure functions that convert between trajectory messages and the core's trajectories."""

from collections.abc import Sequence

from control_msgs.msg import FollowJointTrajectoryGoal, JointTolerance
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.trajectory.follower import TrajectoryFollower
from bullet_sim.control.trajectory.path import Waypoint
from bullet_sim.control.trajectory.request import (
    GoalTolerances,
    InvalidTrajectory,
    RequestedPoint,
    Tolerance,
    TrajectoryRequest,
    chosen,
)
from bullet_sim_ros import convert


def request_from_msg(msg: JointTrajectory) -> TrajectoryRequest:
    """The core's request; a header stamp of 0 means now."""
    points = [RequestedPoint(point.time_from_start.to_sec(), point.positions, point.velocities,
                             point.accelerations) for point in msg.points]
    start = None if msg.header.stamp.is_zero() else msg.header.stamp.to_sec()
    return TrajectoryRequest(msg.joint_names, points, start)


def read_tolerances(parameters: ControllerParameters, joints: Sequence[str]) -> GoalTolerances:
    """Read the tolerances from the parameters below `constraints`."""
    def number(name: str, default: float = 0.0) -> float:
        return parameters.number(f"constraints/{name}", default)

    standing = number("stopped_velocity_tolerance", 0.01)
    return GoalTolerances(
        {name: Tolerance(number(f"{name}/trajectory")) for name in joints},
        {name: Tolerance(number(f"{name}/goal"), standing) for name in joints},
        number("goal_time"))


def goal_tolerances(goal: FollowJointTrajectoryGoal, default: GoalTolerances) -> GoalTolerances:
    """The goal's tolerances; those it does not set are the controller's, `default`.

    InvalidTrajectory if the goal names a joint that the controller does not have.
    """
    return GoalTolerances(_replaced(default.path, goal.path_tolerance),
                          _replaced(default.goal, goal.goal_tolerance),
                          chosen(goal.goal_time_tolerance.to_sec(), default.time))


def _replaced(default: dict[str, Tolerance],
              requested: Sequence[JointTolerance]) -> dict[str, Tolerance]:
    result = dict(default)
    for each in requested:
        if each.name not in result:
            raise InvalidTrajectory(f"a tolerance is for joint {each.name!r}; this controller has "
                                    f"{', '.join(result)}")
        result[each.name] = result[each.name].replaced(each.position, each.velocity,
                                                       each.acceleration)
    return result


def fill_state(msg, follower: TrajectoryFollower, time: float):
    """Fill header, joint_names, desired, actual and error of a state or feedback message."""
    convert.stamped(msg, time)
    msg.joint_names = follower.names
    msg.desired = _point(follower.desired)
    msg.actual = _point(follower.actual)
    msg.error = _point(follower.error)
    return msg


def _point(waypoints: Sequence[Waypoint]) -> JointTrajectoryPoint:
    """The message of waypoints; without accelerations if any is unknown."""
    known = all(waypoint.acceleration is not None for waypoint in waypoints)
    return JointTrajectoryPoint(
        positions=[waypoint.position for waypoint in waypoints],
        velocities=[waypoint.velocity for waypoint in waypoints],
        accelerations=[waypoint.acceleration for waypoint in waypoints] if known else [])
