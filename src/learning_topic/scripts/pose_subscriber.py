#!/usr/bin/env python3
"""Read the turtle's pose.  订阅海龟的位姿。"""

import sys

import rospy

try:
    from turtlesim.msg import Pose
except ImportError:
    sys.exit(
        "pose_subscriber.py needs the package turtlesim, which is not in this workspace: "
        "put one into src/, run catkin_make and source devel/setup.bash"
    )


def pose_callback(msg):
    rospy.loginfo("turtle at x: %.3f, y: %.3f", msg.x, msg.y)


def main():
    rospy.init_node("pose_subscriber", anonymous=True)
    rospy.Subscriber("/turtle1/pose", Pose, pose_callback, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
