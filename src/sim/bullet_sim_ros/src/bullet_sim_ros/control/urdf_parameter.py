"""Waits for the parameter that holds a robot's URDF, while the simulation goes on."""

import logging
import threading
from collections.abc import Callable

import rospy

from bullet_sim_ros import params
from bullet_sim_ros.errors import format_error
from bullet_sim_ros.plugin_host import PluginContext

log = logging.getLogger("bullet_sim.control")

POLL = 0.1  # s, wall


def with_urdf(
    context: PluginContext, namespace: str, name: str, use: Callable[[str], None]
) -> None:
    """Call `use(text)` in the loop: at once if the parameter is set, else as soon as it is.

    The text is empty if the parameter is not a string.

    gazebo_ros_control_plugin.cpp, getURDF, waits in the loop and blocks the whole world; a spawn
    service would not answer meanwhile.
    """
    closed = threading.Event()
    context.on_close(closed.set)
    found = params.find_upwards(namespace, name)
    rospy.loginfo("gazebo_ros_control plugin is waiting for model URDF in parameter [%s] on the "
                  "ROS param server.", found or name)
    if found:
        use(_text(found))
        return

    def look() -> None:
        """Called in the loop, once the parameter is set."""
        if closed.is_set():
            return
        try:
            use(_text(params.find_upwards(namespace, name)))
        except Exception as error:  # logged with the plugin's name
            log.error("%s is not loaded: %s", context.describe(), format_error(error))
            context.close()

    def poll() -> None:
        while not closed.wait(POLL) and not rospy.is_shutdown():
            if params.find_upwards(namespace, name):
                context.host.mailbox.post(look)
                return

    threading.Thread(target=poll, name="urdf", daemon=True).start()


def _text(parameter: str) -> str:
    value = params.below(parameter)
    return value if isinstance(value, str) else ""
