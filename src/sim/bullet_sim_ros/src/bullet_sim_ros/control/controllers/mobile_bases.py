"""The controllers of mobile bases: cmd_vel in, odometry and tf out."""

import logging
from collections.abc import Callable

import rospy
from geometry_msgs.msg import Twist
from roslib.message import get_message_class

from bullet_sim.control.controllers.ackermann_steering_controller import AckermannSteering
from bullet_sim.control.controllers.four_wheel_steering_controller import FourWheelSteering
from bullet_sim.control.controllers.mecanum_drive_controller import MecanumDrive
from bullet_sim.control.controllers.mobile_base import MobileBase
from bullet_sim.control.rate import Rate
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.registry import Controller, controller
from bullet_sim_ros.plugin_host.drive_topics import OdometryOutput

STARTING = 5.0  # s of simulated time from loading, in which a spawner starts the controller
AXLES_MESSAGE = "four_wheel_steering_msgs/FourWheelSteering"

log = logging.getLogger("bullet_sim.control")


class MobileBaseController(Controller):
    """Accepts commands only while it runs; odometry starts at zero when it is loaded."""

    law: type[MobileBase]

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        p = context.parameters
        self.base = self.law.from_parameters(p, context.robot, context.claim)
        self.set_publish_rate(p.number("publish_rate", 50.0))
        self._running = False
        self._was_running, self._loaded = False, context.world_time()
        self._complained: set[str] = set()
        self._alone = not p.flag("allow_multiple_cmd_vel_publishers", True)
        self.odometry = OdometryOutput(
            context, "odom", p.text("odom_frame_id", "odom"), p.text("base_frame_id", "base_link"),
            transform=p.flag("enable_odom_tf", True), queue_size=100,
            pose_covariance=convert.diagonal(p.numbers("pose_covariance_diagonal", 6)),
            twist_covariance=convert.diagonal(p.numbers("twist_covariance_diagonal", 6)))
        self._commands = self.subscribe("cmd_vel", Twist, self._take_twist)

    def set_publish_rate(self, rate_hz: float) -> None:
        """For odometry and transform. SimulationError if the rate is negative or not finite."""
        self._pace = Rate(rate_hz)

    def subscribe(self, topic: str, kind: type,
                  command: Callable[..., Callable[[], None] | None]) -> rospy.Subscriber:
        """`command(message)` returns a function for the loop; refuses messages while stopped.

        One that comes between loading and starting is refused without a word: a driver may start
        before the spawner is done.
        """
        def take(message) -> Callable[[], None] | None:
            if not self._running:
                if self._was_running or self.context.world_time() - self._loaded > STARTING:
                    self._complain(f"{topic}: Can't accept new commands. "
                                   "Controller is not running.")
                return None
            return command(message)

        return self.context.subscribe(topic, kind, take, queue_size=1, tcp_nodelay=True)

    def start(self, time: float) -> None:
        """Accept commands, starting from standstill."""
        self.base.start(time)
        self._running, self._was_running, self._complained = True, True, set()

    def update(self, time: float, period: float) -> None:
        """Drive, and publish odometry when it is due."""
        self.base.update(time, period)
        if self._pace.due(time) and self.odometry.wanted():
            self.odometry.publish(self.base.odometry.sample())

    def stop(self, time: float) -> None:
        """Brake, and refuse commands."""
        self._running, self._complained = False, set()
        self.base.stop()

    def refuse(self, what: str) -> None:
        """Log a warning about a command that cannot be used."""
        log.warning("%s: a command that is %s is ignored", self.context.describe(), what)

    def _complain(self, what: str) -> None:
        """Log an error, once after each start or stop: commands come many times a second."""
        if what not in self._complained:
            self._complained.add(what)
            log.error("%s: %s", self.context.describe(), what)

    def _take_twist(self, msg: Twist) -> Callable[[], None] | None:
        if not convert.is_sane(msg):
            self.refuse(f"not finite, or beyond {convert.LARGEST:g},")
            return None
        senders = self._commands.get_num_connections()
        if self._alone and senders > 1:
            self._complain(f"{senders} publishers of cmd_vel, but allow_multiple_cmd_vel_publishers"
                           " is false: it brakes")
            return lambda: self.base.command(self.context.world_time(), 0.0, 0.0)
        return lambda: self.apply_command(msg)

    def apply_command(self, msg: Twist) -> None:
        """Pass a checked command to the drive; in the loop."""
        self.base.command(self.context.world_time(), msg.linear.x, msg.angular.z)


@controller("ackermann_steering_controller/AckermannSteeringController",
            "steer_drive_controller/SteerDriveController")
class AckermannSteeringController(MobileBaseController):
    """angular.z of cmd_vel is the steering joint's angle, rad.

    So it is in ackermann_steering_controller.cpp, AckermannSteeringController::update.
    steer_drive_controller is the older name in ros_controllers, with the same parameters.
    """

    law = AckermannSteering


@controller("mecanum_drive_controller/MecanumDriveController")
class MecanumDriveController(MobileBaseController):
    """cmd_vel's linear.y is the speed to the left."""

    law = MecanumDrive

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        if not all(context.robot.joints_on(wheel.joint.name) for wheel in self.base.wheels):
            log.warning("%s: its wheels have no rollers (links on passive joints), so they drive "
                        "forward and turn, but do not go sideways; a base without rollers is moved "
                        "by libgazebo_ros_planar_move.so", context.describe())

    def apply_command(self, msg: Twist) -> None:
        """Pass a checked command to the drive; in the loop."""
        self.base.command(self.context.world_time(), msg.linear.x, msg.angular.z, msg.linear.y)


@controller("four_wheel_steering_controller/FourWheelSteeringController")
class FourWheelSteeringController(MobileBaseController):
    """Takes cmd_vel, and cmd_four_wheel_steering if its message's package is installed."""

    law = FourWheelSteering

    def __init__(self, context: ControllerContext):
        super().__init__(context)
        message = get_message_class(AXLES_MESSAGE)
        if message is None:
            log.warning("%s: no package has %s, so cmd_four_wheel_steering is not there; cmd_vel "
                        "is", context.describe(), AXLES_MESSAGE)
        else:
            self.subscribe("cmd_four_wheel_steering", message, self._take_axles)

    def _take_axles(self, msg) -> Callable[[], None] | None:
        command = msg.speed, msg.front_steering_angle, msg.rear_steering_angle
        if not convert.is_sane(command):
            self.refuse(f"not finite, or beyond {convert.LARGEST:g},")
            return None
        return lambda: self.base.command_axles(self.context.world_time(), *command)
