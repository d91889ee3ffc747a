#!/usr/bin/env python3
"""The tutorial's motor_control.py: one speed for all wheels, one angle for both hinges.

教程的 motor_control.py：四个轮子同速，两个铰链同角。没有命令时停车等改进在 motor_control.py
"""

import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import Float64

WHEEL_GAIN = 8.0  # rad/s of all wheels per unit of linear.x
WHEELS = "left_rear", "right_rear", "left_front", "right_front"
HINGES = "left", "right"


class MotorControl:
    def __init__(self):
        self.wheels = [self.publisher(f"{name}_wheel_velocity") for name in WHEELS]
        self.hinges = [self.publisher(f"{name}_steering_hinge_position") for name in HINGES]
        rospy.Subscriber("motor_output", Twist, self.take, queue_size=1)

    def publisher(self, joint):
        return rospy.Publisher(f"/racecar/{joint}_controller/command", Float64, queue_size=1)

    def take(self, msg):
        """Pass a command on. The car keeps it until the next one.  一直执行到下一条命令。"""
        for wheel in self.wheels:
            wheel.publish(WHEEL_GAIN * msg.linear.x)
        for hinge in self.hinges:
            hinge.publish(msg.angular.z)  # rad


def main():
    rospy.init_node("motor_control", anonymous=True)
    MotorControl()
    rospy.spin()


if __name__ == "__main__":
    main()
