"""libgazebo_ros_triggered_camera.so: a picture for each message that asks for one."""

from __future__ import annotations

from bullet_sim_ros.cameras.camera_group import Eyes
from bullet_sim_ros.cameras.camera_publisher import Eye
from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_triggered_camera.so")
class TriggeredCameraPlugin:
    """A camera that stands by for `triggerTopicName`."""

    def __init__(self, host: Host):
        Eyes(host, [Eye(host)]).look_when_told()
