#!/usr/bin/env python3
"""Publish a moving frame: the turtle's pose, over and over.  发布动态坐标变换。"""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from turtlesim.msg import Pose

broadcaster = None


def pose_callback(pose):
    transform = TransformStamped()
    transform.header.stamp = rospy.Time.now()
    transform.header.frame_id = "world"
    transform.child_frame_id = "turtle1"
    transform.transform.translation.x = pose.x
    transform.transform.translation.y = pose.y
    # A rotation by theta about z, as a quaternion.  绕 z 轴转 theta 的四元数
    transform.transform.rotation.z = math.sin(pose.theta / 2)
    transform.transform.rotation.w = math.cos(pose.theta / 2)
    broadcaster.sendTransform(transform)


def main():
    global broadcaster  # one for all callbacks  所有回调共用一个
    rospy.init_node("dynamic_tf_pub")
    broadcaster = tf2_ros.TransformBroadcaster()
    rospy.Subscriber("/turtle1/pose", Pose, pose_callback, queue_size=1)
    rospy.spin()


if __name__ == "__main__":
    main()
