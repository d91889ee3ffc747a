"""libgazebo_ros_joint_pose_trajectory.so: joints are moved along a JointTrajectory."""

import logging
from collections.abc import Callable

from gazebo_msgs.srv import SetJointTrajectory, SetJointTrajectoryResponse
from trajectory_msgs.msg import JointTrajectory

from bullet_sim.errors import PluginError, SimulationError
from bullet_sim.link import Link
from bullet_sim.mechanisms.joint_poses import JointPose, JointPoses
from bullet_sim.model import Model
from bullet_sim_ros import convert, names
from bullet_sim_ros.errors import format_error
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")

INERTIAL = ("world", "/map", "map")


@plugin("libgazebo_ros_joint_pose_trajectory.so")
class JointPoseTrajectoryPlugin:
    """While a trajectory plays, only its model is without physics; SetTrajectory stops the world's.

    Each point is held for its time_from_start (gazebo_ros_joint_pose_trajectory.cpp, UpdateStates).
    The service is always offered; LoadThread offers it only if built with ENABLE_SERVICE.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        namespace = p.namespace(missing="/", empty="/")
        self._poses = JointPoses(context.world)
        context.subscribe(names.join(namespace, p.text("topicName", "set_joint_trajectory")),
                          JointTrajectory, self._take, queue_size=100)
        context.serve(names.join(namespace, p.text("serviceName", "set_joint_trajectory")),
                      SetJointTrajectory, self._serve)
        context.each_step(self._poses.update)
        context.on_reset(self._poses.stop)

    def _take(self, msg: JointTrajectory) -> Callable[[], None]:
        def play() -> None:
            try:
                self._play(msg, None)
            except SimulationError as error:
                log.error("%s: %s", self._context.describe(), format_error(error))
        return play

    def _serve(self, request) -> SetJointTrajectoryResponse:
        def play() -> SetJointTrajectoryResponse:
            model = self._context.world.models.get(request.model_name)
            try:
                if request.set_model_pose and not convert.is_sane(request.model_pose):
                    raise PluginError(f"model_pose must be finite, up to {convert.LARGEST:g}")
                self._play(request.joint_trajectory, model,
                           request.model_pose if request.set_model_pose else None)
            except SimulationError as error:
                return SetJointTrajectoryResponse(False, format_error(error))
            return SetJointTrajectoryResponse(True, "SetJointTrajectory: trajectory set")
        return self._context.host.mailbox.call(play)

    def _play(self, msg: JointTrajectory, model: Model | None, pose=None) -> None:
        held = self._held(msg.header.frame_id)
        model = model or (held.model if held else self._context.model)
        for number, point in enumerate(msg.points):
            if len(point.positions) != len(msg.joint_names):
                raise PluginError(f"point {number} of the trajectory has {len(point.positions)} "
                                  f"positions for {len(msg.joint_names)} joints")
            if not all(abs(value) <= convert.LARGEST for value in point.positions):
                raise PluginError(f"point {number} of the trajectory is not finite, or beyond "
                                  f"{convert.LARGEST:g}")
        if pose is not None:
            model.set_pose(convert.pose_from_msg(pose))
        points = [JointPose(tuple(point.positions), point.time_from_start.to_sec())
                  for point in msg.points]
        self._poses.play(model, msg.joint_names, points, msg.header.stamp.to_sec(),
                         held if held and held.model is model else None)

    def _held(self, frame: str) -> Link | None:
        return None if frame in INERTIAL else self._context.world.link(frame)
