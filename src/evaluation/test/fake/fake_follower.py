#!/usr/bin/env python3
"""Stands in for a lesson in tests: answers each picture with a command, or fails as it is told."""

import sys
import time

import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

LATE = 2.0  # s, wall
MUTE_NUMBER = 20  # one picture in so many is not answered by one that is mute


def main() -> None:
    rospy.init_node("follower")
    behaviour = rospy.myargv(sys.argv)[1]
    if behaviour == "fails":
        sys.exit(3)
    commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)

    def answer(image: Image) -> None:
        if behaviour != "mute" or image.header.seq % MUTE_NUMBER:
            commands.publish(Twist())

    if "late" in behaviour:
        time.sleep(LATE)
    if behaviour != "blind":
        rospy.Subscriber("/camera/rgb/image_raw", Image, answer, queue_size=1)
    rospy.spin()


if __name__ == "__main__":
    main()
