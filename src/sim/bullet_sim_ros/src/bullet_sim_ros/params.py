"""Reads ROS parameters: the node's own, and those that plugins look for."""

from dataclasses import dataclass
from typing import Any

import rospy

from bullet_sim.control.parameters import ControllerParameters
from bullet_sim_ros import names


@dataclass(frozen=True)
class NodeParameters:
    """Parameters below /gazebo."""

    pub_clock_frequency: float = 100.0
    # Hz of simulated time; 0 or less: every step, the default of gazebo_ros_api_plugin.cpp,
    # publishSimTime, which costs each rospy node with sim time a good part of a core.
    pub_state_frequency: float = 100.0  # Hz for model_states and link_states; 0 or less: every step
    enable_ros_network: bool = True
    lockstep: str = ""  # topics to wait for after each camera frame; empty: do not wait
    lockstep_timeout: float = 1.0  # s, wall; 0: none, for a program at a breakpoint
    lockstep_sensor: str = ""  # topic after whose messages to wait, instead of camera frames
    state_log: str = ""  # file for true poses, contacts and calls; empty: none
    recording: str = ""  # file for all links' poses and the scene; empty: none
    run_log: str = ""  # file for all that acts on the world, to repeat the run; empty: none
    replay: str = ""  # such a file, which is to be repeated; empty: none
    profile: bool = False  # print what each stage of the work costs


def read_node_parameters() -> NodeParameters:
    """The parameters, or their defaults; sets use_sim_time to true unless it is set already."""
    if not rospy.has_param(names.USE_SIM_TIME):
        rospy.set_param(names.USE_SIM_TIME, True)
    defaults = NodeParameters()
    return NodeParameters(
        max(0.0, _number(names.PUB_CLOCK_FREQUENCY, defaults.pub_clock_frequency)),
        max(0.0, _number(names.PUB_STATE_FREQUENCY, defaults.pub_state_frequency)),
        bool(rospy.get_param(names.ENABLE_ROS_NETWORK, defaults.enable_ros_network)),
        str(rospy.get_param(names.LOCKSTEP, defaults.lockstep)).strip(),
        _positive(names.LOCKSTEP_TIMEOUT, defaults.lockstep_timeout),
        str(rospy.get_param(names.LOCKSTEP_SENSOR, defaults.lockstep_sensor)).strip(),
        str(rospy.get_param(names.STATE_LOG, defaults.state_log)),
        str(rospy.get_param(names.RECORDING, defaults.recording)),
        str(rospy.get_param(names.RUN_LOG, defaults.run_log)),
        str(rospy.get_param(names.REPLAY, defaults.replay)),
        bool(rospy.get_param(names.PROFILE, defaults.profile)),
    )


def _number(name: str, default: float) -> float:
    value = rospy.get_param(name, default)
    try:
        return float(value)
    except (TypeError, ValueError):
        rospy.logwarn("parameter %s is %r, which is not a number; %g is used",
                      rospy.resolve_name(name), value, default)
        return default


def _positive(name: str, default: float) -> float:
    """As `_number`; what is below 0, which may not mean 0, is no number."""
    value = _number(name, default)
    if value >= 0:
        return value
    rospy.logwarn("parameter %s is %g, which is not 0 or more; %g is used",
                  rospy.resolve_name(name), value, default)
    return default


def below(namespace: str) -> Any:
    """All parameters below a namespace, or the value of a parameter; None if there is nothing."""
    return rospy.get_param(namespace, None)


def of_controllers(namespace: str) -> ControllerParameters:
    """All parameters below an absolute namespace, read once."""
    return ControllerParameters(
        namespace, below(namespace),
        "; was the controller's YAML file loaded there (rosparam load FILE {above})?")


def find_upwards(namespace: str, name: str) -> str | None:
    """Full name of the first such parameter from a namespace upwards; absolute names stay.

    None if there is none.
    """
    parts = [part for part in names.join(namespace, "").split("/") if part]
    for depth in range(len(parts), -1, -1):
        candidate = names.join("/" + "/".join(parts[:depth]), name)
        if rospy.has_param(candidate):
            return candidate
    return None


def own_tf_prefix(namespace: str) -> str:
    """The parameter `tf_prefix` exactly in a plugin's namespace, else empty."""
    return str(below(names.join(namespace, "tf_prefix")) or "")


def tf_prefix(namespace: str) -> str:
    """The parameter `tf_prefix` as found from a plugin's namespace upwards, else empty."""
    name = find_upwards(namespace, "tf_prefix")
    return str(rospy.get_param(name)) if name else ""
