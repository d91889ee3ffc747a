"""libgazebo_ros_triggered_camera.so: a picture for each message that asks for one."""

from __future__ import annotations

from bullet_sim_ros.cameras.camera_group import CameraGroup
from bullet_sim_ros.cameras.camera_publisher import CameraPublisher
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_triggered_camera.so")
class TriggeredCameraPlugin:
    """A camera that stands by for `triggerTopicName`."""

    def __init__(self, context: PluginContext):
        CameraGroup(context, [CameraPublisher(context)]).capture_on_trigger()
