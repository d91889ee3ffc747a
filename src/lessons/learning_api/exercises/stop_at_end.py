#!/usr/bin/env python3
"""Exercise stop_at_end: stop the turtle on exit.  练习：退出前让海龟停下。"""

import time

import rospy
from geometry_msgs.msg import Twist

SPEED, TURN = 0.5, 0.2  # m/s, rad/s
RATE_HZ = 10
SENDING = 0.2  # s: sending takes a moment  发送需要一点时间


class Driver:
    def __init__(self):
        self.publisher = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=1)
        # Yours: let rospy call stop on shutdown.  请补充：让 rospy 在退出时调用 stop

    def drive(self):
        command = Twist()
        command.linear.x, command.angular.z = SPEED, TURN
        self.publisher.publish(command)

    def stop(self):
        self.publisher.publish(Twist())
        time.sleep(SENDING)


def main():
    rospy.init_node("stop_at_end")
    driver = Driver()
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        driver.drive()
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
