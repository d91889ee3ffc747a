"""libgazebo_grasp_fix.so: an object that the fingers press from two sides is held by the palm."""

import logging
import math

from bullet_sim.errors import PluginError
from bullet_sim.mechanisms.grasp import Grasp, GraspParameters
from bullet_sim.plugin_tags import PluginParameters
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_grasp_fix.so", "libgazebo_grasp_plugin.so")
class GraspFixPlugin:
    """Updates by simulated time; GazeboGraspFix.cpp, OnUpdate, goes by the wall clock."""

    def __init__(self, context: PluginContext):
        self._context = context
        p = context.parameters
        most = round(p.number("max_grip_count", 10))
        parameters = GraspParameters(
            math.radians(p.number("forces_angle_tolerance", 120.0)), most,
            round(p.number("grip_count_threshold", most // 2)),
            p.number("release_tolerance", 0.005))
        if p.flag("disable_collisions_on_attach", False):
            log.warning("%s: <disable_collisions_on_attach> has no effect: what is held goes on "
                        "colliding", context.describe())
        # <arm> elements are the newer syntax: several grippers in one plugin
        grasps = [self._grasp(arm, parameters) for arm in p.groups("arm") or [p]]
        rate_hz = p.number("update_rate", 5.0)
        for grasp in grasps:
            context.every(rate_hz, grasp.update)
            context.on_reset(grasp.release)
            context.on_close(grasp.release)

    def _grasp(self, arm: PluginParameters, parameters: GraspParameters) -> Grasp:
        context = self._context
        palm, named = arm.required("palm_link"), arm.texts("gripper_link")
        if not named:
            raise PluginError("it needs a <gripper_link>")
        fingers = [context.model.links[name] for name in named if name in context.model.links]
        for name in named:
            if name not in context.model.links:
                log.error("%s: <gripper_link> %r is not a link; there are: %s", context.describe(),
                          name, ", ".join(context.model.links))
        return Grasp(context.world, context.model.link(palm), fingers, parameters)
