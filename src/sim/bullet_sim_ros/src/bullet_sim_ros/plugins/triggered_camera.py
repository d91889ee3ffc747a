"""libgazebo_ros_triggered_camera.so: a picture for each message that asks for one."""

from __future__ import annotations

from bullet_sim_ros.cameras.eye import Eye
from bullet_sim_ros.cameras.eyes import Eyes
from bullet_sim_ros.plugins.host import Host
from bullet_sim_ros.plugins.registry import plugin


@plugin("libgazebo_ros_triggered_camera.so")
class TriggeredCameraPlugin:
    """A camera that stands by for `triggerTopicName`."""

    def __init__(self, host: Host):
        Eyes(host, [Eye(host)]).look_when_told()
