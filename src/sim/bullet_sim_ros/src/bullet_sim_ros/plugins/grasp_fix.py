"""libgazebo_grasp_fix.so: what a gripper's fingers press from two sides is held by its palm."""

from __future__ import annotations

import logging
import math
from xml.etree.ElementTree import Element

from bullet_sim.description import PluginDescription
from bullet_sim.drives.grasp import Grasp, GraspParameters
from bullet_sim_ros.errors import PluginError
from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.parameters import PluginParameters
from bullet_sim_ros.plugin_host.registry import plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_grasp_fix.so", "libgazebo_grasp_plugin.so")
class GraspFixPlugin:
    """Updates by simulated time (upstream: the wall clock's)."""

    def __init__(self, host: Host):
        self._host = host
        p = host.parameters
        most = round(p.number("max_grip_count", 10))
        parameters = GraspParameters(
            math.radians(p.number("forces_angle_tolerance", 120.0)), most,
            round(p.number("grip_count_threshold", most // 2)),
            p.number("release_tolerance", 0.005))
        if p.flag("disable_collisions_on_attach", False):
            log.warning("%s: <disable_collisions_on_attach> has no effect: what is held goes on "
                        "colliding", host.describe())
        # <arm> elements are the newer way of writing: several grippers in one plugin
        element = host.description.element
        grasps = [self._grasp(arm, parameters) for arm in element.findall("arm") or [element]]
        rate_hz = p.number("update_rate", 5.0)
        for grasp in grasps:
            host.every(rate_hz, grasp.update)
            host.on_reset(grasp.release)
            host.on_close(grasp.release)

    def _grasp(self, arm: Element, parameters: GraspParameters) -> Grasp:
        host = self._host
        palm = PluginParameters(host.model.name, PluginDescription(
            host.description.name, host.description.filename, arm)).required("palm_link")
        named = [(link.text or "").strip() for link in arm.findall("gripper_link")]
        if not named:
            raise PluginError("it needs a <gripper_link>")
        fingers = [host.model.links[name] for name in named if name in host.model.links]
        for name in named:
            if name not in host.model.links:
                log.error("%s: <gripper_link> %r is no link; there are: %s", host.describe(), name,
                          ", ".join(host.model.links))
        return Grasp(host.world, host.model.link(palm), fingers, parameters)
