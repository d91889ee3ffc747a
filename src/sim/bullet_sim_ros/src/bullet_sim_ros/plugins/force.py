"""libgazebo_ros_force.so: the last Wrench received acts on a link at every step."""

from collections.abc import Callable

from geometry_msgs.msg import Wrench

from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext, plugin

NONE = (0.0, 0.0, 0.0)


@plugin("libgazebo_ros_force.so")
class ForcePlugin:
    """The wrench acts at the centre of mass, in world axes, until another one is received."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        self._link = context.model.link(p.required("bodyName"))
        self._force = self._torque = NONE  # N, N m
        topic = names.join(p.namespace(missing="/", empty="/"), p.required("topicName"))
        context.subscribe(topic, Wrench, self._take, queue_size=1)
        context.each_step(self._push)

    def _take(self, msg: Wrench) -> Callable[[], None] | None:
        if self._context.refuses("wrench", msg.force, msg.torque):
            return None
        return lambda: self._set(msg)

    def _set(self, msg: Wrench) -> None:
        self._force, self._torque = convert.triple(msg.force), convert.triple(msg.torque)
        self._push()

    def _push(self) -> None:
        if any(self._force) or any(self._torque):
            self._link.apply_force(self._force, self._torque)
