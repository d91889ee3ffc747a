#!/usr/bin/env python3
"""Make turtlesim's background white: read and set parameters.  读写参数，改背景色。"""

import sys

import rospy
from std_srvs.srv import Empty

WHITE = 255
# Private parameters of the node /turtlesim, so below its name.  节点 /turtlesim 的私有参数
NAMES = ["/turtlesim/background_r", "/turtlesim/background_g", "/turtlesim/background_b"]


def show_background():
    try:
        values = [rospy.get_param(name) for name in NAMES]
    except KeyError as error:
        sys.exit(f"parameter_config.py: no parameter {error}: turtlesim sets it as it starts; "
                 "end it if it runs, and type rosrun turtlesim turtlesim_node")
    for name, value in zip(NAMES, values, strict=True):
        if type(value) is not int:  # somebody has set it  有人改成了别的类型
            sys.exit(f"parameter_config.py: parameter {name} must be a whole number, not "
                     f"{value!r}; type: rosparam set {name} 255")
    rospy.loginfo("background: r %d, g %d, b %d", *values)


def main():
    rospy.init_node("parameter_config")
    show_background()
    for name in NAMES:
        rospy.set_param(name, WHITE)
    show_background()
    # Nodes decide when to read parameters: turtlesim on /clear.  调用 /clear 后才重新读取
    rospy.wait_for_service("/clear")
    try:
        rospy.ServiceProxy("/clear", Empty)()
    except rospy.ServiceException as error:
        rospy.logerr("turtlesim did not clear its background: %s", error)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
