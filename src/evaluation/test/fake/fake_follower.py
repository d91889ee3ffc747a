#!/usr/bin/env python3
"""Stands in for a lesson in tests: answers each picture with a command, or dies when told to."""

import sys

import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import CameraInfo


def main() -> None:
    rospy.init_node("follower")
    if rospy.myargv(sys.argv)[1] == "fails":
        sys.exit(3)
    commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
    rospy.Subscriber("/camera/rgb/camera_info", CameraInfo, lambda _: commands.publish(Twist()))
    rospy.spin()


if __name__ == "__main__":
    main()
