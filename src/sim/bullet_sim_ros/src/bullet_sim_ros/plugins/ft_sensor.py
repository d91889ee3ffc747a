"""libgazebo_ros_ft_sensor.so and libgazebo_ros_f3d.so: geometry_msgs/WrenchStamped."""

import numpy as np
from geometry_msgs.msg import Vector3, Wrench, WrenchStamped

from bullet_sim.sensors.contact import NetForce
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, plugin


@plugin("libgazebo_ros_ft_sensor.so")
class FtSensorPlugin(SensorPlugin):
    """The reaction wrench in a joint, in the child link's frame; needs no `provideFeedback`."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._joint = context.model.joint(p.required("jointName"))
        super().__init__(context, WrenchStamped, p.required("topicName"),
                         self._joint.description.child,
                         noise=f"{context.model.name}::{self._joint.name} wrench")
        self._joint.reaction()  # from now on it is measured
        self.publish_at(p.number("updateRate", 0.0))

    def measure(self) -> WrenchStamped:
        """The wrench that the parent exerts on the child."""
        return _message(self.disturbed(np.concatenate(self._joint.reaction())))


@plugin("libgazebo_ros_f3d.so")
class F3dPlugin(SensorPlugin):
    """The net force on a link, gravity and contacts included: m a, in world axes.

    `frameName` has no effect: frame_id is the tf_prefix and `world` (gazebo_ros_f3d.cpp, Load).
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._net = NetForce(context.world, context.model.link(p.required("bodyName")))
        super().__init__(context, WrenchStamped, p.required("topicName"), "world")
        self.publish_at(0.0)
        context.on_reset(self._net.restart)

    def measure(self) -> WrenchStamped:
        """The mean force and torque since the last measurement."""
        return _message(self._net.sample())


def _message(values: np.ndarray) -> WrenchStamped:
    """The message of a force and a torque, (6,)."""
    numbers = values.tolist()
    return WrenchStamped(wrench=Wrench(Vector3(*numbers[:3]), Vector3(*numbers[3:])))
