"""Common to the controllers of mobile bases: cmd_vel in, odometry and tf out, parameters."""

import logging
import math
from collections.abc import Callable

import rospy
from geometry_msgs.msg import Twist

from bullet_sim.control.controllers.mobile_base import (
    UNBOUNDED,
    BaseOptions,
    MobileBase,
    SpeedLimits,
)
from bullet_sim.control.rate import Rate
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.controller_parameters import ControllerParameters
from bullet_sim_ros.control.registry import Controller
from bullet_sim_ros.plugin_host.drive_topics import OdometryOutput


def read_distance(p: ControllerParameters, robot: RobotFacts, name: str, first: str, second: str,
                  axis: int | None = None) -> float:
    """A parameter, else the distance of two joints, m; with `axis` (0: x, 1: y) along that axis."""
    if p.has(name):
        return p.number(name)
    one, other = robot.pose(first).position, robot.pose(second).position
    return math.dist(one, other) if axis is None else abs(one[axis] - other[axis])


def read_wheel_radius(p: ControllerParameters, robot: RobotFacts, joint: str) -> float:
    """The parameter `wheel_radius`, else the radius of the wheel on a joint, m."""
    return p.number("wheel_radius") if p.has("wheel_radius") else robot.wheel_radius(joint)


STARTING = 5.0  # s of simulated time from loading, in which a spawner starts the controller

log = logging.getLogger("bullet_sim.control")


class MobileBaseController(Controller):
    """Accepts commands only while it runs; odometry starts at zero when it is loaded."""

    def __init__(self, context: ControllerContext, base: MobileBase):
        super().__init__(context)
        p = context.parameters
        self.base = base
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


def read_options(parameters: ControllerParameters) -> BaseOptions:
    """Read the parameters that all bases share."""
    return BaseOptions(
        read_limits(parameters, "linear/x"), read_limits(parameters, "angular/z"),
        parameters.number("cmd_vel_timeout", 0.5),
        round(parameters.number("velocity_rolling_window_size", 10)),
        parameters.flag("open_loop", False))


def read_limits(parameters: ControllerParameters, group: str) -> SpeedLimits:
    """The limits of one speed, from a group of parameters such as `linear/x`."""
    def bounds(quantity: str) -> tuple[float, float]:
        if not parameters.flag(f"{group}/has_{quantity}_limits", False):
            return UNBOUNDED
        greatest = parameters.number(f"{group}/max_{quantity}", 0.0)
        return parameters.number(f"{group}/min_{quantity}", -greatest), greatest

    return SpeedLimits(bounds("velocity"), bounds("acceleration"), bounds("jerk"))
