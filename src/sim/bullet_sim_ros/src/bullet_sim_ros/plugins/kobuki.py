"""libgazebo_ros_kobuki.so: TurtleBot2's base with wheels, gyroscope, bumpers and cliff sensors."""

import math
from collections.abc import Collection, Sequence

from geometry_msgs.msg import Twist
from kobuki_msgs.msg import BumperEvent, CliffEvent, MotorPower, SensorState, WheelDropEvent
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Empty

from bullet_sim.description import SensorDescription
from bullet_sim.drives.kobuki import SECTORS, Kobuki, WheelDrop, pressed_bumpers
from bullet_sim.errors import PluginError
from bullet_sim.link import Link
from bullet_sim.sensors.imu import ImuReading, ImuSensor
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim.sensors.laser import Laser
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host import PluginContext, plugin, subscribe_commands
from bullet_sim_ros.plugin_host.drive_topics import OdometryOutput

CONVERTER_SCALE, CONVERTER_GAP = 76123.0, 0.995  # Kobuki's sensor: its reading for a distance in m


class BaseTopic:
    """A topic of the base; those of events have `look`, which publishes changes since last time."""

    def __init__(self, context: PluginContext, base: str, name: str, kind: type):
        self._context = context
        self._topic = context.advertise(names.join(base, name), kind, queue_size=1)

    def wanted(self) -> int:
        """Whether anybody listens: contacts and rays cost time."""
        return self._topic.get_num_connections()


class BumperTopic(BaseTopic):
    """An event for each of the three bumpers that has changed."""

    def __init__(self, context: PluginContext, base: str, link: Link):
        super().__init__(context, base, "events/bumper", BumperEvent)
        self._link = link
        self._pressed: set[str] = set()

    def pressed(self) -> set[str]:
        """Those of `SECTORS` that are pressed."""
        return pressed_bumpers(self._context.world.contacts(), self._link.scoped_name,
                               self._context.model.pose)

    def look(self) -> None:
        """After a step."""
        pressed = self.pressed()
        for name in SECTORS:
            if (name in pressed) != (name in self._pressed):
                state = BumperEvent.PRESSED if name in pressed else BumperEvent.RELEASED
                self._topic.publish(BumperEvent(bumper=getattr(BumperEvent, name.upper()),
                                                state=state))
        self._pressed = pressed


class WheelDropTopic(BaseTopic):
    """An event for each of the two wheels that lost contact with the floor or regained it."""

    def __init__(self, context: PluginContext, base: str, kobuki: Kobuki):
        super().__init__(context, base, "events/wheel_drop", WheelDropEvent)
        model = context.model
        self._drop = WheelDrop({
            side: f"{model.name}::{joint.description.child}"
            for side, joint in zip(("left", "right"), kobuki.wheels, strict=True)},
            context.world.time)
        self._dropped: set[str] = set()

    def dropped(self) -> set[str]:
        """Those of `left` and `right` that have dropped."""
        world = self._context.world
        return self._drop.dropped(world.contacts(), world.time)

    def look(self) -> None:
        """After a step."""
        dropped = self.dropped()
        for side in sorted(dropped ^ self._dropped):
            state = WheelDropEvent.DROPPED if side in dropped else WheelDropEvent.RAISED
            self._topic.publish(WheelDropEvent(wheel=getattr(WheelDropEvent, side.upper()),
                                               state=state))
        self._dropped = dropped


class CliffTopic(BaseTopic):
    """An event when the floor under one sensor ends or begins again.

    FormatError if the sensor's rays are impossible.
    """

    def __init__(self, context: PluginContext, base: str, side: str, threshold: float, link: Link,
                 sensor: SensorDescription):
        """`threshold` in m: a floor this far down counts as a cliff."""
        super().__init__(context, base, "events/cliff", CliffEvent)
        self.side = side
        self._threshold = threshold
        self._laser = Laser(context.world, link, sensor)
        self._cliff = False

    def read(self) -> tuple[bool, int]:
        """Whether there is a cliff, and the A/D converter's reading."""
        distance = float(self._laser.sample().ranges[0])
        reading = CONVERTER_SCALE * math.atan2(CONVERTER_GAP, max(distance, 0.0))
        return distance >= self._threshold, int(reading) & 0xFFFF

    def look(self) -> None:
        """After a step."""
        cliff, reading = self.read()
        if cliff == self._cliff:
            return
        self._cliff = cliff
        self._topic.publish(CliffEvent(
            sensor=getattr(CliffEvent, self.side.upper()),
            state=CliffEvent.CLIFF if cliff else CliffEvent.FLOOR, bottom=reading))


RATE = 50.0  # Hz, that of the real base; gazebo_ros_kobuki.cpp, OnUpdate, publishes at each step
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
        self._context.subscribe(
            names.join(commands, "motor_power"), MotorPower, queue_size=10,
            take=lambda msg: lambda: self._kobuki.switch(msg.state == MotorPower.ON))
        self._context.subscribe(names.join(commands, "reset_odometry"), Empty, queue_size=10,
                                take=lambda _msg: self._kobuki.reset_odometry)

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


POSE_COVARIANCE = convert.diagonal((0.1, 0.1, 1e6, 1e6, 1e6, 0.05))  # m^2 and rad^2
GYRO_COVARIANCE = convert.diagonal((1e6, 1e6, 0.05))


class KobukiOutput:
    """Frames are odom, base_footprint and base_link, with the tf_prefix."""

    def __init__(
        self, context: PluginContext, kobuki: Kobuki, namespace: str, base: str, transform: bool
    ):
        self._context, self._kobuki = context, kobuki
        prefix = params.tf_prefix(namespace)
        odom, footprint, self._base_link = (
            names.frame(prefix, name) for name in ("odom", "base_footprint", "base_link"))
        self._states = context.advertise(names.join(namespace, "joint_states"), JointState,
                                         queue_size=1)
        self._odometry = OdometryOutput(context, names.join(namespace, "odom"), odom, footprint,
                                        transform=transform, pose_covariance=POSE_COVARIANCE)
        self._imu = context.advertise(names.join(base, "sensors/imu_data"), Imu, queue_size=1)

    def publish(self) -> None:
        """Publish the topics that have subscribers."""
        if self._states.get_num_connections():
            msg = convert.joints_to_msg(sample_joints(self._context.world, self._kobuki.wheels))
            msg.header.frame_id, msg.effort = self._base_link, [0.0, 0.0]
            self._states.publish(msg)
        if self._odometry.wanted():
            self._odometry.publish(self._kobuki.odometry())
        if self._imu.get_num_connections():
            self._imu.publish(self._imu_msg(self._kobuki.imu_reading()))

    def _imu_msg(self, reading: ImuReading) -> Imu:
        msg = convert.imu_to_msg(reading.orientation, reading.angular_velocity,
                                 reading.linear_acceleration)
        msg.orientation_covariance = msg.angular_velocity_covariance = GYRO_COVARIANCE
        return convert.stamped(msg, reading.time, self._base_link)


TICKS = 2578.33 / math.tau  # of a wheel's encoder per rad: 52 per turn of the motor, geared
BATTERY = 165  # 0.1 V: full, and it stays full
BITS = {"right": SensorState.BUMPER_RIGHT, "center": SensorState.BUMPER_CENTRE,
        "left": SensorState.BUMPER_LEFT}  # of the cliff sensors, too
WHEEL_BITS = {"right": SensorState.WHEEL_DROP_RIGHT, "left": SensorState.WHEEL_DROP_LEFT}
WORD = 0xFFFF


class CoreTopic(BaseTopic):
    """`sensors/core`. Currents, duty cycles, buttons and inputs are not simulated: they are 0."""

    def __init__(self, context: PluginContext, base: str, kobuki: Kobuki, bumper: BumperTopic,
                 cliffs: Sequence[CliffTopic], drop: WheelDropTopic):
        super().__init__(context, base, "sensors/core", SensorState)
        self._kobuki = kobuki
        self._bumper, self._drop = bumper, drop
        self._cliffs = {cliff.side: cliff for cliff in cliffs}

    def publish(self) -> None:
        """Publish one message; to be called after a step."""
        time = self._context.world.time
        cliffs = {side: self._cliffs[side].read() for side in BITS}
        left, right = (int(joint.position * TICKS) & WORD for joint in self._kobuki.wheels)
        msg = SensorState(
            time_stamp=round(time * 1000) & WORD, bumper=_bits(self._bumper.pressed(), BITS),
            wheel_drop=_bits(self._drop.dropped(), WHEEL_BITS),
            cliff=_bits([side for side, (cliff, _) in cliffs.items() if cliff], BITS),
            left_encoder=left, right_encoder=right, charger=SensorState.DISCHARGING,
            battery=BATTERY, bottom=[reading for _, reading in cliffs.values()],
            current=[0, 0], analog_input=[0, 0, 0, 0])
        self._topic.publish(convert.stamped(msg, time))


def _bits(sides: Collection[str], bits: dict[str, int]) -> int:
    return sum(bit for side, bit in bits.items() if side in sides)
