"""Calls the running simulator's services, without a node of its own.

The master is that of ROS_MASTER_URI; every failure raises RunError.
"""

from __future__ import annotations

import math

import rosgraph
import rospy
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import DeleteModel, GetWorldProperties, SetModelState, SpawnModel
from geometry_msgs.msg import Pose, Quaternion
from std_srvs.srv import Empty

from run_session.failure import RunError

WORLD, POSE = "/gazebo/get_world_properties", "/gazebo/get_model_state"
UNPAUSE = "/gazebo/unpause_physics"
LIST_CONTROLLERS = "controller_manager/list_controllers"  # below its namespace


WAFFLE = "turtlebot3_waffle"
Place = tuple[float, float, float]  # x, y, m; yaw, rad
FAILURES = (rospy.ServiceException, rospy.ROSException, OSError)


def models() -> list[str]:
    """Names of the models in the world; empty while the simulator does not answer."""
    try:
        return list(_world().model_names)
    except RunError:
        return []


def simulated_time() -> float:
    """Simulated time, s."""
    return _world().sim_time


def pause() -> None:
    """Pause simulated time."""
    call("/gazebo/pause_physics", Empty)


def unpause() -> None:
    """Let simulated time go on."""
    call("/gazebo/unpause_physics", Empty)


def spawn_urdf(name: str, text: str, namespace: str, x: float, y: float) -> None:
    """Spawn a model at x, y (m) in the world."""
    pose = Pose()
    pose.position.x, pose.position.y, pose.orientation.w = x, y, 1.0
    call("/gazebo/spawn_urdf_model", SpawnModel, name, text, namespace, pose, "world")


def spawn_sdf(name: str, text: str, place: Place) -> None:
    """Spawn a model at a place in the world."""
    call("/gazebo/spawn_sdf_model", SpawnModel, name, text, "", pose_message(place), "world")


def delete(name: str) -> None:
    """Delete a model."""
    call("/gazebo/delete_model", DeleteModel, name)


def subscribers(topic: str) -> list[str]:
    """Names of the nodes that subscribe to a topic, as the master knows them."""
    _, subscribed, _ = rosgraph.Master("/bench").getSystemState()
    return next((nodes for name, nodes in subscribed if name == topic), [])


def _world() -> object:
    return call("/gazebo/get_world_properties", GetWorldProperties)


def call(name: str, kind: type, *arguments: object, wait: float | None = None) -> object:
    """A service's response; RunError if there is none, or if it reports no success.

    `wait`: s, wall, to wait for the service; None: it has to be available now.
    """
    try:
        if wait is not None:
            rospy.wait_for_service(name, wait)
        answer = rospy.ServiceProxy(name, kind)(*arguments)
    except FAILURES as error:
        raise RunError(f"service {name}: {error}") from error
    if not getattr(answer, "success", True):
        raise RunError(f"service {name}: {answer.status_message}")
    return answer


def pose_message(place: Place) -> Pose:
    """A pose on the ground."""
    pose = Pose()
    pose.position.x, pose.position.y = place[:2]
    pose.orientation.z, pose.orientation.w = math.sin(place[2] / 2), math.cos(place[2] / 2)
    return pose


def place_of(pose: Pose) -> Place:
    """x, y and yaw of a pose that is upright, or nearly so."""
    return pose.position.x, pose.position.y, yaw_of(pose.orientation)


def yaw_of(turn: Quaternion) -> float:
    """Yaw in rad of an upright, or nearly upright, pose."""
    return math.atan2(2 * (turn.w * turn.z + turn.x * turn.y),
                      1 - 2 * (turn.y * turn.y + turn.z * turn.z))


def put(name: str, place: Place, wait: float) -> None:
    """Set a model's pose in the world; `wait` as in `call`."""
    state = ModelState(model_name=name, pose=pose_message(place), reference_frame="world")
    call("/gazebo/set_model_state", SetModelState, state, wait=wait)
