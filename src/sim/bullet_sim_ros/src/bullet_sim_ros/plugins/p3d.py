"""libgazebo_ros_p3d.so: nav_msgs/Odometry of a link as the world has it."""

from __future__ import annotations

import numpy as np
from nav_msgs.msg import Odometry

from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.sensors.ground_truth import GroundTruth
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin

INERTIAL = ("world", "/world", "map", "/map")


@plugin("libgazebo_ros_p3d.so")
class P3dPlugin:
    """Seen from another link, the twist is truly that (upstream turns it the wrong way round).

    The offsets are in the link's axes, so that a lumped link's are right in any pose (upstream adds
    them in the world's).
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        namespace = p.namespace(missing="/", empty="/")
        link = context.model.link(p.required("bodyName"))
        topic = names.join(namespace, p.required("topicName"))
        frame = p.text("frameName", "world")
        reference = None if frame in INERTIAL else context.model.link(frame)
        offset = Pose(p.vector("xyzOffset"), quaternion_from_rpy(*p.vector("rpyOffset")))
        self._truth = GroundTruth(context.world, link, offset, reference)
        self._world, self._child = context.world, link.name
        self._frame = names.frame(params.own_tf_prefix(namespace), frame)
        self._noise = p.deviation("gaussianNoise")
        self._random_name = f"{link.scoped_name}::{context.description.name}"
        self._poses = context.advertise(topic, Odometry, queue_size=1)
        context.every(p.number("updateRate", 0.0), self._measure, self._poses.get_num_connections,
                      whole_steps=True)

    def _measure(self) -> None:
        reading = self._truth.sample()
        msg = Odometry(child_frame_id=self._child)
        msg.header.stamp, msg.header.frame_id = convert.stamp(reading.time), self._frame
        msg.pose.pose = convert.pose_to_msg(reading.pose)
        msg.twist.twist = convert.twist_to_msg(reading.twist)
        if self._noise:
            self._disturb(msg)
        self._poses.publish(msg)

    def _disturb(self, msg: Odometry) -> None:
        noise = self._world.random(self._random_name).normal(0.0, self._noise, 6).tolist()
        linear, angular = msg.twist.twist.linear, msg.twist.twist.angular
        for vector, values in ((linear, noise[:3]), (angular, noise[3:])):
            vector.x, vector.y, vector.z = (
                value + more for value, more in zip((vector.x, vector.y, vector.z), values,
                                                    strict=True))
        variances = np.diag([self._noise ** 2] * 6).ravel().tolist()
        msg.pose.covariance = msg.twist.covariance = variances
