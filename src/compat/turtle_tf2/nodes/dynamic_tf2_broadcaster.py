#!/usr/bin/env python3
"""Adds the frame carrot1, which circles turtle1 at 10 m once in two seconds."""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

RATE_HZ = 10
RADIUS = 10.0  # m
TURN_RATE = math.pi  # rad/s


def main():
    rospy.init_node("dynamic_tf2_broadcaster")
    broadcaster = tf2_ros.TransformBroadcaster()
    carrot = TransformStamped()
    carrot.header.frame_id, carrot.child_frame_id = "turtle1", "carrot1"
    carrot.transform.rotation.w = 1.0
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        carrot.header.stamp = rospy.Time.now()
        angle = TURN_RATE * carrot.header.stamp.to_sec()
        carrot.transform.translation.x = RADIUS * math.sin(angle)
        carrot.transform.translation.y = RADIUS * math.cos(angle)
        broadcaster.sendTransform(carrot)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
