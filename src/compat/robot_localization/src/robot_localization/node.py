"""The node: upstream's parameters in, odometry/filtered and a transform out."""

import threading

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import (
    AccelWithCovarianceStamped,
    Point,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Vector3,
)
from nav_msgs.msg import Odometry

from robot_localization.filtering.ekf import (
    ACCELERATION,
    ANGLES,
    POSITION,
    PROCESS_NOISE,
    RATES,
    SIZE,
    VELOCITY,
    Ekf,
    angles_of,
    matrix_of,
    pose_matrix,
    quaternion_of,
)
from robot_localization.filtering.measurements import BadConfig, Filter, square
from robot_localization.sources import Frames, check_stamp, frame, number, open_sources

NOT_HERE = ("use_control", "smooth_lagged_data", "dynamic_process_noise_covariance",
            "disabled_at_startup")


class LocalizationNode:
    def __init__(self):
        self.rate = number("frequency", 30.0)
        if not self.rate > 0.0:
            raise BadConfig(f"frequency is {self.rate:g}; it has to be above 0 Hz")
        self.timeout = number("sensor_timeout", 1.0 / self.rate)
        self.map = frame("map_frame", "map")
        self.odom = frame("odom_frame", "odom")
        self.base = frame("base_link_frame", "base_link")
        self.output = frame("base_link_frame_output", self.base)
        self.world = frame("world_frame", self.odom)
        if self.world not in (self.map, self.odom):
            raise BadConfig(f"world_frame '{self.world}' has to be map_frame '{self.map}' or "
                            f"odom_frame '{self.odom}'")
        self.offset = rospy.Duration(number("transform_time_offset", 0.0))
        self.to_now = rospy.get_param("~predict_to_current_time", False)
        self.reset_on_jump = rospy.get_param("~reset_on_time_jump", False)
        self.lock, self.waiting, self.heard = threading.Lock(), [], None
        self.filter = self.new_filter()
        self.odometry = rospy.Publisher("odometry/filtered", Odometry, queue_size=20)
        self.acceleration = (rospy.Publisher("accel/filtered", AccelWithCovarianceStamped,
                                             queue_size=20)
                             if rospy.get_param("~publish_acceleration", False) else None)
        self.transforms = (tf2_ros.TransformBroadcaster() if rospy.get_param("~publish_tf", True)
                           else None)
        self.frames = Frames(self.world, self.base)
        rospy.Subscriber("set_pose", PoseWithCovarianceStamped, self.on_set_pose, queue_size=1)
        if not open_sources(self.frames, self.take):
            rospy.logwarn(f"{rospy.get_name()}: none of odom0, imu0, pose0 and twist0 is set, so "
                          "nothing will be published")
        for name in NOT_HERE:
            if rospy.get_param(f"~{name}", False):
                rospy.logwarn(f"{rospy.get_name()}: {name} is not there; it counts as false")

    def new_filter(self):
        state = np.array(rospy.get_param("~initial_state", [0.0] * SIZE), dtype=float)
        if state.shape != (SIZE,):
            raise BadConfig(f"initial_state has to be a list of {SIZE} numbers")
        ekf = Ekf(state, process_noise=square(
            rospy.get_param("~process_noise_covariance", list(PROCESS_NOISE)),
            "process_noise_covariance"))
        name = "initial_estimate_covariance"
        if rospy.has_param(f"~{name}"):
            ekf.covariance = square(rospy.get_param(f"~{name}"), name)
        return Filter(ekf, bool(rospy.get_param("~two_d_mode", False)))

    def take(self, measurements):
        with self.lock:
            self.waiting += measurements
            self.heard = rospy.get_time()

    def on_set_pose(self, message):
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        try:
            check_stamp(message.header.stamp)
            world = self.frames.transform(self.world, message.header.frame_id,
                                          message.header.stamp)
        except tf2_ros.TransformException as error:
            rospy.logwarn(f"{rospy.get_name()}: set_pose: {error}")
            return
        pose = world @ pose_matrix([place.x, place.y, place.z],
                                   matrix_of([turn.x, turn.y, turn.z, turn.w]))
        covariance = np.array(message.pose.covariance).reshape(6, 6)
        if not (np.isfinite(pose).all() and np.isfinite(covariance).all()):
            rospy.logwarn(f"{rospy.get_name()}: set_pose: it holds nan or inf; nothing is changed")
            return
        with self.lock:
            self.waiting.clear()
            self.filter.place((message.header.stamp or rospy.Time.now()).to_sec(),
                              np.concatenate([pose[:3, 3], angles_of(pose[:3, :3])]), covariance)

    def on_jump_back(self):
        if self.reset_on_jump:
            with self.lock:
                self.waiting.clear()
                self.filter = self.new_filter()

    def update(self):
        """Take in what came, and publish the estimate if there is one."""
        now = rospy.get_time()
        with self.lock:
            measurements, self.waiting = self.waiting, []
            self.filter.take(measurements)
            silent = self.heard is not None and now - self.heard >= self.timeout
            if self.to_now or silent:
                self.filter.advance(now)
            if self.filter.stamp is None:
                return
            stamp = rospy.Time.from_sec(self.filter.stamp)
            state, covariance = self.filter.ekf.state.copy(), self.filter.ekf.covariance.copy()
        self.publish(stamp, state, covariance)

    def publish(self, stamp, state, covariance):
        odometry = Odometry(child_frame_id=self.output)
        odometry.header.stamp, odometry.header.frame_id = stamp, self.world
        pose, twist = odometry.pose, odometry.twist
        pose.pose.position = Point(*state[POSITION])
        pose.pose.orientation = Quaternion(*quaternion_of(state[ANGLES]))
        pose.covariance = covariance[:6, :6].ravel().tolist()
        twist.twist.linear, twist.twist.angular = Vector3(*state[VELOCITY]), Vector3(*state[RATES])
        twist.covariance = covariance[6:12, 6:12].ravel().tolist()
        if self.transforms:
            self.send_transform(stamp, state)
        self.odometry.publish(odometry)
        if self.acceleration:
            message = AccelWithCovarianceStamped()
            message.header.stamp, message.header.frame_id = stamp, self.output
            message.accel.accel.linear = Vector3(*state[ACCELERATION])
            whole = np.zeros((6, 6))
            whole[:3, :3] = covariance[ACCELERATION, ACCELERATION]
            message.accel.covariance = whole.ravel().tolist()
            self.acceleration.publish(message)

    def send_transform(self, stamp, state):
        """world to base; or map to odom, where another node says odom to base."""
        pose = pose_matrix(state[POSITION], matrix_of(quaternion_of(state[ANGLES])))
        child = self.output
        if self.world == self.map and self.map != self.odom:
            try:
                pose = pose @ self.frames.transform(self.base, self.odom, stamp)
            except tf2_ros.TransformException as error:
                rospy.logwarn_throttle(5.0, f"{rospy.get_name()}: no transform {self.world} to "
                                       f"{self.odom}: {error}")
                return
            child = self.odom
        message = TransformStamped(child_frame_id=child)
        message.header.stamp, message.header.frame_id = stamp + self.offset, self.world
        message.transform.translation = Vector3(*pose[:3, 3])
        message.transform.rotation = Quaternion(*quaternion_of(angles_of(pose[:3, :3])))
        self.transforms.sendTransform(message)


def main(name: str) -> int:
    """Run until the end; 1 if a parameter cannot be used."""
    rospy.init_node(name)
    try:
        node = LocalizationNode()
    except (BadConfig, TypeError, ValueError) as error:
        rospy.logfatal(f"{rospy.get_name()}: {error}")
        return 1
    before = rospy.get_time()
    rate = rospy.Rate(node.rate, reset=True)
    try:
        while not rospy.is_shutdown():
            if rospy.get_time() < before:
                node.on_jump_back()
            before = rospy.get_time()
            node.update()
            rate.sleep()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
    return 0
