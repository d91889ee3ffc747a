"""States on topics: model_states, link_states, and the scene as text; and those that set states."""

from collections.abc import Callable
from typing import Any

import rospy
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates
from std_msgs.msg import String

from bullet_sim.errors import SimulationError
from bullet_sim.nested import NestedModel
from bullet_sim.pose import Pose
from bullet_sim.rendering.scene_text import scene_to_text
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.services.links import set_link_state
from bullet_sim_ros.services.states import set_model_state
from bullet_sim_ros.simulation import Simulation


class SceneTopic:
    """Latched; sent while subscribed to, and again when links, visuals or lights change.

    Motion is in link_states; in a paused world, which publishes none, a new text is sent instead.
    """

    def __init__(self, world: World):
        self._world = world
        self._publisher = rospy.Publisher(names.SCENE, String, queue_size=1, latch=True)
        self._sent_version: int | None = None  # version of the scene
        self._still: tuple[Pose, ...] = ()  # of all links, while paused

    def update(self) -> None:
        """Called in each turn of the loop, paused or not: costs little while nothing changes."""
        if not self._publisher.get_num_connections():
            return
        still = self._poses() if self._world.paused else self._still
        if self._sent_version == self._world.scene.version and still == self._still:
            return
        self._sent_version, self._still = self._world.scene.version, still
        self._publisher.publish(String(scene_to_text(self._world.update_scene())))

    def _poses(self) -> tuple[Pose, ...]:
        return tuple(link.pose for model in self._world.models.values()
                     for link in model.links.values())


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

        resolved = rospy.resolve_name(topic)
        number = self._simulation.inputs.add(resolved, kind, lambda msg: lambda: take(msg))

        def receive(msg) -> None:
            mailbox = self._simulation.mailbox
            mailbox.announce(resolved, msg)
            mailbox.post(lambda: take(msg), Input(resolved, number, msg))

        rospy.Subscriber(topic, kind, receive, queue_size=10)


def _states(msg: ModelStates | LinkStates, rows) -> ModelStates | LinkStates:
    for name, pose, twist in rows:
        msg.name.append(name)
        msg.pose.append(convert.pose_to_msg(pose))
        msg.twist.append(convert.twist_to_msg(twist))
    return msg
