"""model_states and link_states out, set_model_state in."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rospy
from gazebo_msgs.msg import LinkStates, ModelState, ModelStates

from bullet_sim.errors import SimulationError
from bullet_sim_ros import convert, names
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.services.states import set_model_state

if TYPE_CHECKING:
    from bullet_sim_ros.simulation import Simulation


class StateTopics:
    """Built only while somebody subscribes."""

    def __init__(self, simulation: Simulation, parameters: NodeParameters):
        self._simulation = simulation
        self._models = rospy.Publisher(names.MODEL_STATES, ModelStates, queue_size=10)
        self._links = rospy.Publisher(names.LINK_STATES, LinkStates, queue_size=10)
        rospy.Subscriber(names.SET_MODEL_STATE, ModelState, self._on_set, queue_size=10)
        rate_hz = parameters.pub_state_frequency
        simulation.agenda.add(rate_hz, self._publish_models, self._models.get_num_connections)
        simulation.agenda.add(rate_hz, self._publish_links, self._links.get_num_connections)

    def _publish_models(self) -> None:
        models = self._simulation.world.models.values()
        self._models.publish(_states(ModelStates(), ((m.name, m.pose, m.twist) for m in models)))

    def _publish_links(self) -> None:
        models = self._simulation.world.models.values()
        links = (link for model in models for link in model.links.values())
        self._links.publish(_states(
            LinkStates(), ((link.scoped_name, link.pose, link.twist) for link in links)))

    def _on_set(self, msg: ModelState) -> None:
        self._simulation.mailbox.leave(lambda: self._set(msg))

    def _set(self, msg: ModelState) -> None:
        try:
            set_model_state(self._simulation.world, msg)
        except SimulationError as error:
            rospy.logerr("topic %s: %s", rospy.resolve_name(names.SET_MODEL_STATE), error)


def _states(msg: ModelStates | LinkStates, rows) -> ModelStates | LinkStates:
    for name, pose, twist in rows:
        msg.name.append(name)
        msg.pose.append(convert.pose_to_msg(pose))
        msg.twist.append(convert.twist_to_msg(twist))
    return msg
