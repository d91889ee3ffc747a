#!/usr/bin/env python3
"""Publish a static frame: where the radar is mounted.  发布静态坐标变换。"""

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped


def main():
    rospy.init_node("static_tf_pub")
    transform = TransformStamped()
    transform.header.stamp = rospy.Time.now()
    transform.header.frame_id = "world"  # parent  父坐标系
    transform.child_frame_id = "radar"  # child  子坐标系
    transform.transform.translation.x = 0.2  # m
    transform.transform.translation.y = 0.0
    transform.transform.translation.z = 0.5
    transform.transform.rotation.w = 1.0  # no rotation; all zeros would be invalid  不能全为零
    tf2_ros.StaticTransformBroadcaster().sendTransform(transform)
    rospy.loginfo("world -> radar: 0.2 0.0 0.5")
    rospy.spin()  # latched: later listeners get it too, while this node runs  节点须保持运行


if __name__ == "__main__":
    main()
