"""libgazebo_ros_wheel_slip.so: read and checked; wheels keep the grip of their friction."""

import logging

from bullet_sim.errors import PluginError
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_wheel_slip.so", "libWheelSlipPlugin.so")
class WheelSlipPlugin:
    """The engine has no slip that grows with the force; this is logged as a warning."""

    def __init__(self, context: PluginContext):
        wheels = context.description.element.findall("wheel")
        if not wheels:
            raise PluginError('it needs a <wheel link_name="...">')
        for wheel in wheels:
            context.model.link(wheel.get("link_name", ""))
        log.warning("%s is read, but has no effect: wheels slip only beyond their friction",
                    context.describe())
