"""libroboticsgroup_gazebo_mimic_joint_plugin.so and its kin: a joint follows another one."""

import logging

from bullet_sim.control.hardware import GAINS, read_joint_gains
from bullet_sim.control.pid import Pid
from bullet_sim.mechanisms.mimic import MimicJoint, MimicParameters
from bullet_sim_ros import names, params
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libroboticsgroup_gazebo_mimic_joint_plugin.so",
        "libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so",
        "libgazebo_mimic_joint_plugin.so")
class MimicJointPlugin:
    """The joint is driven by a strong motor, so that it can grip.

    roboticsgroup's mimic_joint_plugin.cpp, UpdateChild, sets its position, even through obstacles.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._world = context.world
        leader, follower = (context.model.joint(p.required(tag)) for tag in ("joint", "mimicJoint"))
        self._mimic = MimicJoint(leader, follower, MimicParameters(
            p.number("multiplier", 1.0), p.number("offset", 0.0), p.number("sensitiveness", 0.0),
            p.number("maxEffort", 1.0)), self._pid(context, follower.name))
        context.each_step(self._follow)
        context.on_reset(self._mimic.reset)

    @staticmethod
    def _pid(context: PluginContext, joint: str) -> Pid | None:
        p = context.parameters
        # In files of older versions the tag is empty: its presence counts.
        if not p.has("hasPID") or not p.flag("hasPID", True):
            return None
        namespace = p.namespace(missing="/", empty="/")
        gains = read_joint_gains(params.of_controllers(names.join(namespace, "")), [joint])
        if joint not in gains:
            where = names.join(namespace, f"{GAINS}/{joint}")
            log.warning("%s: <hasPID>, but there is no parameter %s/p: the joint is held without",
                        context.describe(), where)
            return None
        return Pid(gains[joint])

    def _follow(self) -> None:
        self._mimic.update(self._world.timestep)


@plugin("libroboticsgroup_gazebo_disable_link_plugin.so",
        "libroboticsgroup_upatras_gazebo_disable_link_plugin.so")
class DisableLinkPlugin:
    """Only checks that the link exists.

    disable_link_plugin.cpp, Load, calls Link::SetEnabled(false): the first contact wakes the link.
    """

    def __init__(self, context: PluginContext):
        context.model.link(context.parameters.required("link"))
