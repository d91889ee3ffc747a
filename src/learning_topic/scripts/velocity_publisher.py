#!/usr/bin/env python3
"""Drive the turtle in a circle: publish its velocity.  发布速度，让海龟转圈。"""

import rospy
from geometry_msgs.msg import Twist

SPEED = 0.5  # m/s
TURN = 0.2  # rad/s
RATE_HZ = 10


def main():
    rospy.init_node("velocity_publisher", anonymous=True)
    publisher = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=10)
    command = Twist()
    command.linear.x = SPEED
    command.angular.z = TURN
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        publisher.publish(command)
        rospy.loginfo("velocity: %.2f m/s, %.2f rad/s", command.linear.x, command.angular.z)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
