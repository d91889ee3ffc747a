"""libgazebo_ros_camera.so: images and their CameraInfo while somebody listens."""

from __future__ import annotations

from bullet_sim_ros.cameras.camera_group import Eyes
from bullet_sim_ros.cameras.camera_publisher import Eye
from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_camera.so")
class CameraPlugin:
    """Also of sensors of type wideanglecamera."""

    def __init__(self, host: Host):
        Eyes(host, [Eye(host)]).look_at_rate()
