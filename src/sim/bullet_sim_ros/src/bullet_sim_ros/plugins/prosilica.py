"""libgazebo_ros_prosilica.so: a camera that streams; being asked for single pictures is absent."""

from __future__ import annotations

import logging

from bullet_sim_ros import params
from bullet_sim_ros.cameras.camera_group import CameraGroup
from bullet_sim_ros.cameras.camera_publisher import CameraPublisher
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin

log = logging.getLogger("bullet_sim.plugins")

STREAMING, POLLED = "streaming", "polled"


@plugin("libgazebo_ros_prosilica.so")
class ProsilicaPlugin:
    """`trigger_mode` is searched for upwards from the camera's namespace, once."""

    def __init__(self, context: PluginContext):
        camera = CameraPublisher(context)
        name = params.find_upwards(camera.settings.namespace, "trigger_mode")
        mode = str(params.below(name)) if name else STREAMING
        if mode == POLLED:
            log.warning("%s: %s is %s, and polled_camera/GetPolledImage is not offered here: there "
                        "will be no pictures; set it to %s", context.describe(), name, POLLED,
                        STREAMING)
            return
        if mode != STREAMING:
            log.error(
                "%s: %s is %r; there are %s and %s; %s is used",
                context.describe(),
                name,
                mode,
                STREAMING,
                POLLED,
                STREAMING,
            )
        CameraGroup(context, [camera]).capture_at_rate()
