"""libgazebo_ros_multicamera.so and its triggered twin: a left and a right camera."""

from __future__ import annotations

import logging

from bullet_sim_ros.cameras.camera_group import Eyes
from bullet_sim_ros.cameras.camera_publisher import Eye
from bullet_sim_ros.errors import PluginError
from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.registry import plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_multicamera.so")
class MulticameraPlugin:
    """Both take their pictures at once and share a frame."""

    def __init__(self, host: Host):
        _open_pair(host).look_at_rate()


@plugin("libgazebo_ros_triggered_multicamera.so")
class TriggeredMulticameraPlugin:
    """Each has a trigger topic; either gives a picture of both."""

    def __init__(self, host: Host):
        _open_pair(host).look_when_told()


def _open_pair(host: Host) -> Eyes:
    """The cameras whose names have `left` or `right` in them; only the right one has a baseline."""
    eyes = []
    for number, camera in enumerate(host.sensor.cameras):
        if "left" in camera.name:
            eyes.append(Eye(host, number, "/left", 0.0))
        elif "right" in camera.name:
            eyes.append(Eye(host, number, "/right", host.parameters.number("hackBaseline", 0.0)))
        else:
            log.warning("%s: camera %r is left out: its name has neither left nor right in it",
                        host.describe(), camera.name)
    if not eyes:
        raise PluginError(f"sensor {host.sensor.name} needs a <camera> with left or right in its "
                          "name")
    return Eyes(host, eyes)
