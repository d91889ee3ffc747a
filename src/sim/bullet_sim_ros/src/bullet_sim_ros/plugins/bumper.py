"""libgazebo_ros_bumper.so: gazebo_msgs/ContactsState of a contact sensor."""

from gazebo_msgs.msg import ContactsState, ContactState
from geometry_msgs.msg import Vector3, Wrench

from bullet_sim.sensors.contact import ContactSensor, TouchingPair
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, plugin


@plugin("libgazebo_ros_bumper.so")
class BumperPlugin(SensorPlugin):
    """Contacts in world axes, whatever `frameName` is; empty `states` while nothing touches.

    The sensor's own collision always comes first; in gazebo_ros_bumper.cpp, OnContact, the order
    is the engine's.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._sensor = ContactSensor(context.world, context.link, context.sensor)
        super().__init__(context, ContactsState, p.text("bumperTopicName", "bumper_states"),
                         p.text("frameName", "world"))
        self.publish_readings()

    def measure(self) -> ContactsState:
        """The present contacts."""
        pairs = self._sensor.sample()
        return ContactsState(states=[
            self._state(pair, index, len(pairs)) for index, pair in enumerate(pairs)])

    def _state(self, pair: TouchingPair, index: int, count: int) -> ContactState:
        state = ContactState(collision1_name=pair.own, collision2_name=pair.other)
        state.info = (f"Debug:  i:({index}/{count})     my geom:{pair.own}   "
                      f"other geom:{pair.other}         time:{self.world.time:.9f}\n")
        state.wrenches = [_wrench(force, torque)
                          for force, torque in zip(pair.forces, pair.torques, strict=True)]
        state.total_wrench = _wrench(_sum(pair.forces), _sum(pair.torques))
        state.contact_positions = [Vector3(*position) for position in pair.positions]
        state.contact_normals = [Vector3(*normal) for normal in pair.normals]
        state.depths = list(pair.depths)
        return state


def _wrench(force, torque) -> Wrench:
    return Wrench(Vector3(*force), Vector3(*torque))


def _sum(vectors: list) -> list[float]:
    return [sum(parts) for parts in zip(*vectors, strict=True)]
