"""The API for plugins: context, tags, registry, and output that several share.

It corresponds to gazebo_plugins/include/gazebo_plugins/gazebo_ros_utils.h.
"""

from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.drive_topics import open_odometry, subscribe_commands
from bullet_sim_ros.plugin_host.registry import plugin
from bullet_sim_ros.plugin_host.sensor_plugin import SensorPlugin, no_tf_prefix

__all__ = ["PluginContext", "SensorPlugin", "no_tf_prefix", "open_odometry", "plugin",
           "subscribe_commands"]
