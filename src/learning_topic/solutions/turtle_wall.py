#!/usr/bin/env python3
"""Exercise turtle_wall: the turtle stops before the wall.  练习：海龟在墙前停下。"""

import rospy
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose

SPEED = 1.0  # m/s
STOP_X = 9.0  # m; the wall is at 11.09  墙在 11.09 处


class Turtle:
    def __init__(self):
        self.cmd_vel_pub = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("/turtle1/pose", Pose, self.pose_callback, queue_size=1)

    def pose_callback(self, pose):
        """Called for each pose: drive on or stop.  每个位姿调用一次：前进或停下。"""
        command = Twist()
        if pose.x < STOP_X:
            command.linear.x = SPEED
        self.cmd_vel_pub.publish(command)


def main():
    rospy.init_node("turtle_wall")
    Turtle()
    rospy.spin()


if __name__ == "__main__":
    main()
