"""libgazebo_ros_depth_camera.so: a Kinect without an upper limit for depth."""

from __future__ import annotations

from bullet_sim_ros.plugin_host.registry import plugin
from bullet_sim_ros.plugins.openni_kinect import OpenniKinectPlugin


@plugin("libgazebo_ros_depth_camera.so")
class DepthCameraPlugin(OpenniKinectPlugin):
    """Sends both camera_info topics (upstream advertises them and never sends any)."""

    has_far_cutoff = False
