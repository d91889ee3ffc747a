"""The topics odomN, imuN, poseN and twistN: messages in, measurements out; their parameters."""

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

from robot_localization.filtering.ekf import (
    ACCELERATION,
    ANGLES,
    RATES,
    angles_of,
    matrix_of,
    pose_matrix,
)
from robot_localization.filtering.measurements import (
    BadConfig,
    chosen,
    moved_twist,
    of_block,
    turned,
    turned_by,
    velocity_between,
    without_gravity,
)


def number(name, default):
    """Raises BadConfig if it is none."""
    value = rospy.get_param(f"~{name}", default)
    try:
        return float(value)
    except (TypeError, ValueError):
        raise BadConfig(f"{name} is {value!r}; it has to be a number") from None


def frame(name, default):
    """Without the slash that tf had before it."""
    return str(rospy.get_param(f"~{name}", default)).lstrip("/")


KINDS = {"odom": Odometry, "imu": Imu, "pose": PoseWithCovarianceStamped,
         "twist": TwistWithCovarianceStamped}
FAR = 2.0e9  # s; a process in which tf2 subtracts stamps of 68 years apart is aborted


class Frames:
    """The frames of the filter, and transforms between them and the sensors'."""

    def __init__(self, world, base):
        self.world, self.base = world, base
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)

    def transform(self, target, source, stamp):
        """The matrix (4, 4) that takes points of `source` to `target`; the newest, if none then.

        Raises TransformException.
        """
        source = source.lstrip("/")
        if source in ("", target):
            return np.eye(4)
        if "\0" in source:
            raise tf2_ros.TransformException(f"no frame can be called {source!r}")
        try:
            found = self.buffer.lookup_transform(target, source, stamp)
        except tf2_ros.ExtrapolationException:
            found = self.buffer.lookup_transform(target, source, rospy.Time(0))
        move, turn = found.transform.translation, found.transform.rotation
        return pose_matrix([move.x, move.y, move.z], matrix_of([turn.x, turn.y, turn.z, turn.w]))


def check_stamp(stamp):
    """Raise TransformException for one too far from now for tf2; 0 means the newest."""
    if abs(stamp.to_sec() - rospy.get_time()) > FAR and not stamp.is_zero():
        raise tf2_ros.TransformException(f"a stamp of {stamp.secs} s is too far from now")


class Source:
    """One topic. `name` is the parameter's: odom0, imu1 ..."""

    def __init__(self, kind, name, frames, sink):
        def option(key, default):
            return rospy.get_param(f"~{name}_{key}", default)

        self.name, self.frames, self.sink = name, frames, sink
        self.config = chosen(option("config", [False] * 15), f"{name}_config")
        self.differential, self.relative = option("differential", False), option("relative", False)
        self.gravity = (number("gravitational_acceleration", 9.80665)
                        if option("remove_gravitational_acceleration", False) else 0.0)
        self.rejections = {key: number(f"{name}_{key}_rejection_threshold", np.inf)
                           for key in ("pose", "twist", "linear_acceleration", "angular_velocity")}
        self.first = self.before = None
        handler = {"odom": self.on_odom, "imu": self.on_imu, "pose": self.on_pose,
                   "twist": self.on_twist}[kind]
        rospy.Subscriber(rospy.get_param(f"~{name}"), KINDS[kind], self.guarded, handler,
                         queue_size=option("queue_size", 10),
                         tcp_nodelay=option("nodelay", False))

    def guarded(self, message, handler):
        """One line for a sensor that cannot be placed; it counts from when it can."""
        try:
            check_stamp(message.header.stamp)
            measurements = [found for found in handler(message) if found is not None]
        except tf2_ros.TransformException as error:
            rospy.logwarn_throttle(10.0, f"{rospy.get_name()}: {self.name}: {error}")
            return
        self.sink(measurements)

    def on_odom(self, message):
        yield from self.pose(message.header, message.header.frame_id, message.pose)
        yield from self.twist(message.header, message.child_frame_id, message.twist)

    def on_pose(self, message):
        yield from self.pose(message.header, message.header.frame_id, message.pose)

    def on_twist(self, message):
        yield from self.twist(message.header, message.header.frame_id, message.twist)

    def pose(self, header, frame, measured):
        if not self.config[:6].any():
            return
        place, turn = measured.pose.position, measured.pose.orientation
        world = self.frames.transform(self.frames.world, frame, header.stamp)
        pose = world @ pose_matrix([place.x, place.y, place.z],
                                   matrix_of([turn.x, turn.y, turn.z, turn.w]))
        covariance = turned(np.array(measured.covariance).reshape(6, 6), world[:3, :3])
        yield self.placed(header.stamp.to_sec(), pose, covariance, self.config[:6])

    def placed(self, stamp, pose, covariance, used):
        """A pose as it is, from the first one on (relative), or as a velocity (differential)."""
        if self.relative and self.first is None and not np.isfinite(pose).all():
            return None  # those after it would be relative to nothing
        if self.differential:
            before, self.before = self.before, (stamp, pose, covariance)
            if before is None or stamp <= before[0]:
                return None
            dt = stamp - before[0]
            config = np.zeros(15, dtype=bool)
            config[6:12] = used
            to_body = pose[:3, :3].T  # upstream's sum of variances times the time between
            return of_block(stamp, config, 6, velocity_between(before[1], pose, dt),
                            turned(covariance + before[2], to_body) * dt, self.rejections["pose"])
        if self.relative:
            self.first = pose if self.first is None else self.first
            pose = np.linalg.inv(self.first) @ pose
        values = np.concatenate([pose[:3, 3], angles_of(pose[:3, :3])])
        config = np.zeros(15, dtype=bool)
        config[:6] = used
        return of_block(stamp, config, 0, values, covariance, self.rejections["pose"])

    def twist(self, header, frame, measured):
        if not self.config[6:12].any():
            return
        base = self.frames.transform(self.frames.base, frame, header.stamp)
        linear, angular = measured.twist.linear, measured.twist.angular
        values = moved_twist(np.array([linear.x, linear.y, linear.z,
                                       angular.x, angular.y, angular.z]), base)
        covariance = turned(np.array(measured.covariance).reshape(6, 6), base[:3, :3])
        yield of_block(header.stamp.to_sec(), self.config, 6, values, covariance,
                       self.rejections["twist"])

    def on_imu(self, imu):
        stamp = imu.header.stamp.to_sec()
        base = self.frames.transform(self.frames.base, imu.header.frame_id, imu.header.stamp)
        turn, rotation = imu.orientation, base[:3, :3]
        attitude = turned_by([turn.x, turn.y, turn.z, turn.w], base)
        if self.config[ANGLES].any() and imu.orientation_covariance[0] != -1.0:
            covariance = np.eye(6)
            covariance[3:, 3:] = _three(imu.orientation_covariance)
            used = self.config[:6].copy()
            used[:3] = False
            yield self.placed(stamp, pose_matrix(np.zeros(3), attitude), covariance, used)
        if self.config[RATES].any() and imu.angular_velocity_covariance[0] != -1.0:
            rates = imu.angular_velocity
            yield of_block(stamp, self.config, RATES.start,
                           rotation @ [rates.x, rates.y, rates.z],
                           turned(_three(imu.angular_velocity_covariance), rotation),
                           self.rejections["angular_velocity"])
        if self.config[ACCELERATION].any() and imu.linear_acceleration_covariance[0] != -1.0:
            felt = imu.linear_acceleration
            values = without_gravity(rotation @ [felt.x, felt.y, felt.z], attitude, self.gravity)
            yield of_block(stamp, self.config, ACCELERATION.start, values,
                           turned(_three(imu.linear_acceleration_covariance), rotation),
                           self.rejections["linear_acceleration"])


def _three(covariance) -> np.ndarray:
    return np.array(covariance).reshape(3, 3)


def open_sources(frames: Frames, sink) -> list[Source]:
    """A source for each of odom0, odom1 ..., imu0 ... that is set; `sink` gets Measurements."""
    found = []
    for kind in KINDS:
        number = 0
        while rospy.has_param(f"~{kind}{number}"):
            found.append(Source(kind, f"{kind}{number}", frames, sink))
            number += 1
    return found
