"""The robot's base: velocity commands, velocity from odometry, and stopping."""

from __future__ import annotations

import math
import subprocess
import sys
import threading

import numpy as np
import rospy
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from move_base.stop_guard import DRIVEN, STANDING

SLOWEST = (0.5, 1.0)  # m/s and rad/s; a robot commanded less may still be pushed this fast

TOPICS = {"twist": ("cmd_vel", Twist), "ackermann": ("ackermann_cmd", AckermannDriveStamped)}


def twist(velocity: np.ndarray) -> Twist:
    """geometry_msgs/Twist of (vx, vy, omega)."""
    message = Twist()
    message.linear.x, message.linear.y, message.angular.z = map(float, velocity)
    return message


def ackermann(velocity: np.ndarray, wheelbase: float, stamp: rospy.Time) -> AckermannDriveStamped:
    """A car's command for (vx, _, omega), with the steering angle for `wheelbase`, m."""
    message = AckermannDriveStamped()
    message.header.stamp = stamp
    message.drive.speed = float(velocity[0])
    if velocity[0]:
        message.drive.steering_angle = math.atan(wheelbase * velocity[2] / velocity[0])
    return message


class Base:
    """Publishes velocities. With a guard, a second process stops the robot if this one dies."""

    def __init__(self, command_type: str, wheelbase: float, odom_topic: str, guarded: bool) -> None:
        self._kind, self._wheelbase = command_type, wheelbase
        topic, message = TOPICS[command_type]
        self._commands = rospy.Publisher(topic, message, queue_size=1)
        self._lock = threading.Lock()
        self._driven = self._closed = False
        self._guard = self._start_guard() if guarded else None
        self._limits: tuple[float, float] | None = None
        self._slow_for = 0.0
        self._velocity = np.zeros(3)
        self._possible = np.inf, np.inf
        self.odometry_fault = ""  # fault in its last message, which then counts as missing
        self.heard: rospy.Time | None = None
        self._odometry: rospy.Subscriber | None = None
        self.listen_to(odom_topic)

    def listen_to(self, odom_topic: str) -> None:
        """Takes the robot's velocity from this topic."""
        if self._odometry is not None:
            self._odometry.unregister()
        self._odometry = rospy.Subscriber(odom_topic, Odometry, self._take, queue_size=1)
        self.odom_topic = self._odometry.resolved_name

    @property
    def velocity(self) -> np.ndarray:
        """(vx, vy, omega) from odometry, m/s and rad/s; finite."""
        return self._velocity

    def expect(self, speed: float, turn: float, factor: float) -> None:
        """Commands will not exceed `speed`, m/s, and `turn`, rad/s.

        Odometry with more than `factor` times that counts as missing; factor 0: only odometry that
        is not finite does.
        """
        self._possible = tuple(factor * max(told, least) if factor else np.inf
                               for told, least in zip((speed, turn), SLOWEST, strict=True))

    def limit(self, speed: float, turn: float, distance: float) -> None:
        """Limit the next `distance`, m, to `speed`, m/s, and `turn`, rad/s."""
        self._slow_for = distance
        self._limits = max(speed, 1e-3), max(turn, 1e-3)

    def drive(self, velocity: np.ndarray) -> None:
        """Command (vx, vy, omega), m/s and rad/s; a limit slows it down along the same arc."""
        velocity = np.zeros(3) if self._closed else np.asarray(velocity, float)
        limits = self._limits  # odometry's thread may reset them meanwhile
        if limits is not None:
            share = max(np.hypot(*velocity[:2]) / limits[0], abs(velocity[2]) / limits[1], 1.0)
            velocity = velocity / share
        driven = bool(velocity.any())
        if driven:  # told to the guard before the robot moves, and until it was commanded to stop
            self._tell_guard(True)
        self._publish(velocity)
        if not driven:
            self._tell_guard(False)

    def stop(self) -> None:
        """Command zero velocity."""
        self.drive(np.zeros(3))

    def close(self) -> None:
        """Command zero and end the guard, which sends zero if this node no longer could."""
        self._closed = True
        self._publish(np.zeros(3))
        if self._guard is not None:
            with self._lock:
                self._guard.stdin.close()

    def _publish(self, velocity: np.ndarray) -> None:
        message = (twist(velocity) if self._kind == "twist"
                   else ackermann(velocity, self._wheelbase, rospy.Time.now()))
        try:
            self._commands.publish(message)
        except rospy.ROSException:
            pass  # the node is ending

    def _take(self, message: Odometry) -> None:
        moving = message.twist.twist
        velocity = np.array([moving.linear.x, moving.linear.y, moving.angular.z])
        fault = self._fault_of(velocity)
        if fault and not self.odometry_fault and self._driven:
            rospy.logwarn_throttle(5.0, f"odometry on {self.odom_topic}: {fault}; left out")
        self.odometry_fault = fault
        if fault:
            return
        self._velocity = velocity
        now = rospy.Time.now()
        if self._limits is not None and self.heard is not None:
            self._slow_for -= np.hypot(*self._velocity[:2]) * max((now - self.heard).to_sec(), 0.0)
            if self._slow_for <= 0.0:
                self._limits = None
        self.heard = now

    def _fault_of(self, velocity: np.ndarray) -> str:
        """Why this cannot be the robot's velocity, or ""."""
        speed, turn = self._possible
        if (np.isfinite(velocity).all() and math.hypot(*velocity[:2]) <= speed
                and abs(velocity[2]) <= turn):
            return ""
        return (f"it says ({velocity[0]:.3g}, {velocity[1]:.3g}) m/s and {velocity[2]:.3g} rad/s; "
                f"more than {speed:.3g} m/s or {turn:.3g} rad/s cannot be, by odometry_factor and "
                "the local planner's limits")

    def _start_guard(self) -> subprocess.Popen:
        """In a session of its own: Ctrl-C in the terminal must not end it before this node."""
        name = f"{rospy.get_name().rpartition('/')[2]}_stop_guard"
        return subprocess.Popen(
            [sys.executable, "-m", "move_base.stop_guard", self._kind,
             self._commands.resolved_name, f"__name:={name}", f"__ns:={rospy.get_namespace()}"],
            stdin=subprocess.PIPE, text=True, bufsize=1, start_new_session=True)

    def _tell_guard(self, driven: bool) -> None:
        if self._guard is None:
            self._driven = driven
            return
        with self._lock:
            if self._guard.poll() is not None and not self._closed:
                rospy.logwarn("the process that stops the robot if this one is killed has ended; "
                              "it starts again")
                self._guard, self._driven = self._start_guard(), False
            if driven == self._driven:
                return
            self._driven = driven
            try:
                self._guard.stdin.write(DRIVEN if driven else STANDING)
                self._guard.stdin.flush()
            except (OSError, ValueError):
                pass  # noticed at the next command
