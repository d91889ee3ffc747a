#!/usr/bin/env python3
"""Publishes odom, and the transform odom -> base_link, from the angles of wheels and hinges.

Navigation needs it. As a real car's node, it only uses joint states, no simulator ground truth.
"""

import math

import rospy
import tf2_ros
from car_control.driving.ackermann import HingeAngles
from car_control.driving.dead_reckoning import DeadReckoning
from car_control.motor import MotorSettings
from car_control.node import read_settings
from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

JOINTS = ("left_rear_axle", "right_rear_axle", "left_steering_joint", "right_steering_joint")
ODOM, BASE = "odom", "base_link"
VARIANCES = {0: 0.01, 7: 0.01, 14: 1e6, 21: 1e6, 28: 1e6, 35: 0.03}  # of x, y, ... yaw; m^2, rad^2
COVARIANCE = [VARIANCES.get(i, 0.0) for i in range(36)]


def odometry_message(motion, stamp):
    message = Odometry()
    message.header.stamp, message.header.frame_id, message.child_frame_id = stamp, ODOM, BASE
    message.pose.pose.position.x, message.pose.pose.position.y = motion.x, motion.y
    message.pose.pose.orientation = Quaternion(
        0, 0, math.sin(motion.yaw / 2), math.cos(motion.yaw / 2))
    message.twist.twist.linear.x = motion.speed
    message.twist.twist.angular.z = motion.turn_rate
    message.pose.covariance = message.twist.covariance = COVARIANCE
    return message


def transform_message(odometry):
    message = TransformStamped(header=odometry.header, child_frame_id=BASE)
    message.transform.translation.x = odometry.pose.pose.position.x
    message.transform.translation.y = odometry.pose.pose.position.y
    message.transform.rotation = odometry.pose.pose.orientation
    return message


class WheelOdometry:
    def __init__(self, settings):
        self.reckoning = DeadReckoning(settings.geometry)
        self.last_stamp = None
        self.odometry = rospy.Publisher("odom", Odometry, queue_size=10)
        self.transforms = tf2_ros.TransformBroadcaster()
        self.states = rospy.Subscriber(f"{settings.namespace}/joint_states", JointState, self.take,
                                       queue_size=10, tcp_nodelay=True)

    def take(self, states):
        place = dict(zip(states.name, states.position))
        missing = [joint for joint in JOINTS if not math.isfinite(place.get(joint, math.nan))]
        if missing:
            rospy.logwarn_throttle(5, f"no angle of {', '.join(missing)} on "
                                      f"{self.states.resolved_name}")
            return
        if states.header.stamp == self.last_stamp:
            return  # a repeated transform causes a warning in every listener
        self.last_stamp = states.header.stamp
        left, right, *hinges = (place[joint] for joint in JOINTS)
        motion = self.reckoning.add(states.header.stamp.to_sec(), left, right,
                                    HingeAngles(*hinges))
        odometry = odometry_message(motion, states.header.stamp)
        self.odometry.publish(odometry)
        self.transforms.sendTransform(transform_message(odometry))


def main():
    rospy.init_node("wheel_odometry")
    WheelOdometry(read_settings(MotorSettings, "car_control.yaml", "motor_control"))
    rospy.spin()


if __name__ == "__main__":
    main()
