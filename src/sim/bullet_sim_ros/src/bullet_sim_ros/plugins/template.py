"""libgazebo_ros_template.so: an example to copy from; it loads and does nothing."""

from __future__ import annotations

from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_template.so")
class TemplatePlugin:
    """In a model or in the world."""

    def __init__(self, host: Host):
        del host
