"""Publishes model_states and link_states; subscribes to set_model_state and set_link_state."""

from collections.abc import Callable
from typing import Any

import rospy
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates

from bullet_sim.errors import SimulationError
from bullet_sim.nested import NestedModel
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.links import set_link_state
from bullet_sim_ros.services.states import set_model_state
from bullet_sim_ros.simulation import Simulation


class StateTopics:
    """The states are published only while they have subscribers."""

    def __init__(self, simulation: Simulation, rate_hz: float):
        self._simulation = simulation
        self._models = rospy.Publisher(names.MODEL_STATES, ModelStates, queue_size=10)
        self._links = rospy.Publisher(names.LINK_STATES, LinkStates, queue_size=10)
        self._obey(names.SET_MODEL_STATE, ModelState, set_model_state)
        self._obey(names.SET_LINK_STATE, LinkState, set_link_state)
        simulation.scheduler.add(rate_hz, self._publish_models, self._models.get_num_connections)
        simulation.scheduler.add(rate_hz, self._publish_links, self._links.get_num_connections)

    def _publish_models(self) -> None:
        models = self._simulation.world.models.values()
        self._models.publish(_states(ModelStates(), ((m.name, m.pose, m.twist) for m in models)))

    def _publish_links(self) -> None:
        models = self._simulation.world.models.values()
        links = (link for model in models for link in NestedModel(model).links())
        self._links.publish(_states(
            LinkStates(), ((link.scoped_name, link.pose, link.twist) for link in links)))

    def _obey(self, topic: str, kind: type, put: Callable[[World, Any], None]) -> None:
        """Subscribe, and run `put(world, message)` in the loop; errors are logged."""
        def take(msg) -> None:
            try:
                put(self._simulation.world, msg)
            except SimulationError as error:
                rospy.logerr("topic %s: %s", rospy.resolve_name(topic), error)

        def receive(msg) -> None:
            mailbox = self._simulation.mailbox
            mailbox.announce(rospy.resolve_name(topic), msg)
            mailbox.post(lambda: take(msg))

        rospy.Subscriber(topic, kind, receive, queue_size=10)


def _states(msg: ModelStates | LinkStates, rows) -> ModelStates | LinkStates:
    for name, pose, twist in rows:
        msg.name.append(name)
        msg.pose.append(convert.pose_to_msg(pose))
        msg.twist.append(convert.twist_to_msg(twist))
    return msg
