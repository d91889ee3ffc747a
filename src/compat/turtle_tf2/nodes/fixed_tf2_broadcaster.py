#!/usr/bin/env python3
"""Adds the frame carrot1, 2 m to the left of turtle1."""

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

RATE_HZ = 10


def main():
    rospy.init_node("fixed_tf2_broadcaster")
    broadcaster = tf2_ros.TransformBroadcaster()
    carrot = TransformStamped()
    carrot.header.frame_id, carrot.child_frame_id = "turtle1", "carrot1"
    carrot.transform.translation.y = 2.0
    carrot.transform.rotation.w = 1.0
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        carrot.header.stamp = rospy.Time.now()
        broadcaster.sendTransform(carrot)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
