#!/usr/bin/env python3
"""Exercise radar_turned: the radar points to the left.  练习：雷达朝左安装。"""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

YAW = math.pi / 2  # rad, to the left  向左


def main():
    rospy.init_node("static_tf_pub")
    transform = TransformStamped()
    transform.header.stamp = rospy.Time.now()
    transform.header.frame_id = "world"  # parent  父坐标系
    transform.child_frame_id = "radar"  # child  子坐标系
    transform.transform.translation.x = 0.2  # m
    transform.transform.translation.z = 0.5
    transform.transform.rotation.w = 1.0  # yours: a rotation by YAW about z  请修改：绕 z 轴转 YAW
    tf2_ros.StaticTransformBroadcaster().sendTransform(transform)
    rospy.spin()


if __name__ == "__main__":
    main()
