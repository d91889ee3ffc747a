"""libgazebo_ros_kobuki.so: TurtleBot2's base with wheels, gyroscope, bumpers and cliff sensors."""

from collections.abc import Callable

from geometry_msgs.msg import Twist
from kobuki_msgs.msg import MotorPower
from std_msgs.msg import Empty

from bullet_sim.description import SensorDescription
from bullet_sim.drives.kobuki import Kobuki
from bullet_sim.link import Link
from bullet_sim.sensors.imu import ImuSensor
from bullet_sim_ros import names, params
from bullet_sim_ros.errors import PluginError
from bullet_sim_ros.plugin_host import PluginContext, plugin, subscribe_commands
from bullet_sim_ros.plugins.kobuki_core import CoreTopic
from bullet_sim_ros.plugins.kobuki_events import BumperTopic, CliffTopic, WheelDropTopic
from bullet_sim_ros.plugins.kobuki_output import KobukiOutput

RATE = 50.0  # Hz: what the real base does; gazebo_ros_kobuki.cpp, OnUpdate, is at each step
SIDES = ("left", "center", "right")


@plugin("libgazebo_ros_kobuki.so")
class KobukiPlugin:
    """Commands, events and the gyroscope are below NAMESPACE/mobile_base, the rest in NAMESPACE."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        namespace = p.namespace(missing=context.model.name, empty=context.model.name)
        prefix = params.below(names.join(namespace, "base_prefix"))
        base = names.join(namespace, str(prefix or "mobile_base"))
        imu = ImuSensor(context.world, *self._sensor(p.required("imu_name")))
        self._kobuki = Kobuki(
            context.world, self._joint("left"), self._joint("right"), imu, self._number("torque"),
            self._number("wheel_separation"), self._number("wheel_diameter"),
            self._number("velocity_command_timeout"))
        self._output = KobukiOutput(context, self._kobuki, namespace, base,
                                    p.flag("publish_tf", False))
        threshold = self._number("cliff_detection_threshold")
        cliffs = [CliffTopic(context, base, side, threshold,
                             *self._sensor(p.required(f"cliff_sensor_{side}_name")))
                  for side in SIDES]
        bumper = BumperTopic(context, base, self._sensor(p.required("bumper_name"))[0])
        self._subscribe(base)
        context.each_step(self._kobuki.update)
        context.every(RATE, self._output.publish)
        drop = WheelDropTopic(context, base, self._kobuki)
        for events in (bumper, drop, *cliffs):
            context.every(RATE, events.look, events.wanted)
        core = CoreTopic(context, base, self._kobuki, bumper, cliffs, drop)
        context.every(RATE, core.publish, core.wanted)
        context.on_reset(self._kobuki.reset)

    def _subscribe(self, base: str) -> None:
        commands = names.join(base, "commands")
        subscribe_commands(self._context, commands, "velocity", self._command, queue_size=10)
        for name, kind, take in (("motor_power", MotorPower, self._take_power),
                                 ("reset_odometry", Empty, self._take_reset)):
            self._context.subscribe(names.join(commands, name), kind, take, queue_size=10)

    def _number(self, tag: str) -> float:
        self._context.parameters.required(tag)
        return self._context.parameters.number(tag, 0.0)

    def _joint(self, side: str):
        return self._context.model.joint(
            self._context.parameters.required(f"{side}_wheel_joint_name")
        )

    def _sensor(self, name: str) -> tuple[Link, SensorDescription]:
        """A sensor of the model by its name."""
        found = {sensor.name: (link, sensor) for link in self._context.model.links.values()
                 for sensor in link.description.sensors}
        if name not in found:
            raise PluginError(f"the model has no sensor {name!r}; there are: "
                              f"{', '.join(found) or 'none'}")
        return found[name]

    def _command(self, msg: Twist) -> None:
        self._kobuki.command(msg.linear.x, msg.angular.z)

    def _take_power(self, msg: MotorPower) -> Callable[[], None]:
        return lambda: self._kobuki.switch(msg.state == MotorPower.ON)

    def _take_reset(self, _msg: Empty) -> Callable[[], None]:
        return self._kobuki.reset_odometry
