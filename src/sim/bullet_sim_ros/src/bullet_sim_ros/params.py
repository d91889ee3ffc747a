"""The only reader of ROS parameters: the node's own, and tf_prefix for plugins."""

from __future__ import annotations

from dataclasses import dataclass

import rospy

from bullet_sim_ros import names


@dataclass(frozen=True)
class NodeParameters:
    """Parameters below /gazebo."""

    pub_clock_frequency: float = 100.0
    # Hz of simulated time; 0 or less: every step. Upstream's default is every step, which costs
    # each rospy node with sim time a good part of a core.
    pub_state_frequency: float = 100.0  # Hz for model_states and link_states; 0 or less: every step
    enable_ros_network: bool = True
    lockstep: str = ""  # topic to wait for after each camera frame; empty: do not wait
    lockstep_timeout: float = 1.0  # s, wall
    profile: bool = False  # print what each stage of the work costs


def read_node_parameters() -> NodeParameters:
    """What the launch file set, else the defaults; switches simulated time on unless decided."""
    if not rospy.has_param(names.USE_SIM_TIME):
        rospy.set_param(names.USE_SIM_TIME, True)
    defaults = NodeParameters()
    return NodeParameters(
        max(0.0, _number(names.PUB_CLOCK_FREQUENCY, defaults.pub_clock_frequency)),
        max(0.0, _number(names.PUB_STATE_FREQUENCY, defaults.pub_state_frequency)),
        bool(rospy.get_param(names.ENABLE_ROS_NETWORK, defaults.enable_ros_network)),
        str(rospy.get_param(names.LOCKSTEP, defaults.lockstep)).strip(),
        max(0.0, _number(names.LOCKSTEP_TIMEOUT, defaults.lockstep_timeout)),
        bool(rospy.get_param(names.PROFILE, defaults.profile)),
    )


def _number(name: str, default: float) -> float:
    value = rospy.get_param(name, default)
    try:
        return float(value)
    except (TypeError, ValueError):
        where = rospy.resolve_name(name)
        rospy.logwarn("parameter %s is %r, which is no number; %g is used", where, value, default)
        return default


def tf_prefix(namespace: str) -> str:
    """`tf_prefix` as found from a plugin's namespace upwards, else empty."""
    parts = [part for part in names.join(namespace, "tf_prefix").split("/") if part][:-1]
    for depth in range(len(parts), -1, -1):
        name = "/" + "/".join([*parts[:depth], "tf_prefix"])
        if rospy.has_param(name):
            return str(rospy.get_param(name))
    return ""
