#!/usr/bin/env python3
"""Follow, 1 of 3: spawn a second turtle.  跟随（一）：生成第二只海龟。"""

import sys

import rospy
from turtlesim.srv import Spawn

X, Y, THETA = 1.0, 1.0, 3.14  # m, m, rad
NAME = "turtle2"


def main():
    rospy.init_node("generate_new")
    rospy.wait_for_service("/spawn")
    try:
        response = rospy.ServiceProxy("/spawn", Spawn)(X, Y, THETA, NAME)
        rospy.loginfo("spawned: %s", response.name)
    except rospy.ServiceException as error:
        sys.exit(f"no turtle: {error}: is there a {NAME} already?")


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
