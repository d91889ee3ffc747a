"""libgazebo_ros_camera.so: images and their CameraInfo while somebody listens."""

from __future__ import annotations

from bullet_sim_ros.cameras.camera_group import CameraGroup
from bullet_sim_ros.cameras.camera_publisher import CameraPublisher
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_camera.so")
class CameraPlugin:
    """Also of sensors of type wideanglecamera."""

    def __init__(self, context: PluginContext):
        CameraGroup(context, [CameraPublisher(context)]).capture_at_rate()
