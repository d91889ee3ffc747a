#!/usr/bin/env python3
"""Call a service: turtlesim spawns a second turtle.  调用服务，再生成一只海龟。"""

import sys

import rospy
from turtlesim.srv import Spawn

X, Y, THETA = 2.0, 2.0, 0.0  # m, m, rad
NAME = "turtle2"


def main():
    rospy.init_node("turtle_spawn")
    rospy.loginfo("waiting for /spawn")
    rospy.wait_for_service("/spawn")  # until turtlesim is running  等待 turtlesim 启动
    spawn = rospy.ServiceProxy("/spawn", Spawn)
    try:
        response = spawn(X, Y, THETA, NAME)
    except rospy.ServiceException as error:
        sys.exit(f"no turtle: {error}: is there a {NAME} already?")
    rospy.loginfo("spawned: %s", response.name)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
