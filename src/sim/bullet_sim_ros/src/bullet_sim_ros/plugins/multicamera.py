"""libgazebo_ros_multicamera.so and its triggered twin: a left and a right camera."""

from __future__ import annotations

import logging

from bullet_sim_ros.cameras.camera_group import CameraGroup
from bullet_sim_ros.cameras.camera_publisher import CameraPublisher
from bullet_sim_ros.errors import PluginError
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_multicamera.so")
class MulticameraPlugin:
    """Both take their pictures at once and share a frame."""

    def __init__(self, context: PluginContext):
        _open_pair(context).capture_at_rate()


@plugin("libgazebo_ros_triggered_multicamera.so")
class TriggeredMulticameraPlugin:
    """Each has a trigger topic; either gives a picture of both."""

    def __init__(self, context: PluginContext):
        _open_pair(context).capture_on_trigger()


def _open_pair(context: PluginContext) -> CameraGroup:
    """The cameras whose names have `left` or `right` in them; only the right one has a baseline."""
    cameras = []
    for number, camera in enumerate(context.sensor.cameras):
        if "left" in camera.name:
            cameras.append(CameraPublisher(context, number, "/left", 0.0))
        elif "right" in camera.name:
            cameras.append(
                CameraPublisher(
                    context, number, "/right", context.parameters.number("hackBaseline", 0.0)
                )
            )
        else:
            log.warning("%s: camera %r is left out: its name has neither left nor right in it",
                        context.describe(), camera.name)
    if not cameras:
        raise PluginError(
            f"sensor {context.sensor.name} needs a <camera> with left or right in its name"
        )
    return CameraGroup(context, cameras)
