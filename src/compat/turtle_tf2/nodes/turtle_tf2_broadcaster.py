#!/usr/bin/env python3
"""Tells tf2 where a turtle is: world -> the turtle named by ~turtle."""

import math
import sys

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from turtlesim.msg import Pose


def transform_of(pose, turtle):
    transform = TransformStamped()
    transform.header.stamp, transform.header.frame_id = rospy.Time.now(), "world"
    transform.child_frame_id = turtle
    transform.transform.translation.x = pose.x
    transform.transform.translation.y = pose.y
    transform.transform.rotation.z = math.sin(pose.theta / 2)
    transform.transform.rotation.w = math.cos(pose.theta / 2)
    return transform


def main():
    rospy.init_node("tf2_turtle_broadcaster")
    turtle = rospy.get_param("~turtle", None)
    if turtle is None:
        sys.exit("turtle_tf2_broadcaster.py: which turtle? type: "
                 "rosrun turtle_tf2 turtle_tf2_broadcaster.py _turtle:=turtle1")
    broadcaster = tf2_ros.TransformBroadcaster()
    rospy.Subscriber(
        f"/{turtle}/pose", Pose,
        lambda pose: broadcaster.sendTransform(transform_of(pose, turtle)), queue_size=1,
    )
    rospy.spin()


if __name__ == "__main__":
    main()
