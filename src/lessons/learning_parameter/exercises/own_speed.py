#!/usr/bin/env python3
"""Exercise own_speed: a parameter sets the turtle's speed.  练习：速度由参数决定。"""

import rospy
from geometry_msgs.msg import Twist

SPEED = 1.0  # m/s, if the parameter is not set  没有设置参数时
RATE_HZ = 10


def speed():
    """The speed in m/s; called for each command.  每条命令都会调用。"""
    return SPEED  # yours: the private parameter `speed`, if set  请修改：优先用私有参数 speed


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
