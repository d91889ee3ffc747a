#!/usr/bin/env python3
"""Exercise own_speed: a parameter sets the turtle's speed.  练习：速度由参数决定。"""

import sys

import rospy
from geometry_msgs.msg import Twist

SPEED = 1.0  # m/s, if the parameter is not set  没有设置参数时
RATE_HZ = 10


def speed():
    """The speed in m/s; called for each command.  每条命令都会调用。"""
    value = rospy.get_param("~speed", SPEED)
    if type(value) not in (int, float):  # a text cannot be sent as a speed  文字不能当作速度
        sys.exit(f"{rospy.resolve_name('~speed')} must be a number in m/s, not {value}")
    return value


def main():
    rospy.init_node("own_speed")
    publisher = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        command = Twist()
        command.linear.x = speed()
        command.angular.z = 0.5  # rad/s: stay inside the window  不驶出窗口
        publisher.publish(command)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
