#!/usr/bin/env python3
"""Spawns turtle2 and lets it follow turtle1, whose place it asks tf for."""

import math

import rospy
import tf
from geometry_msgs.msg import Twist
from turtlesim.srv import Spawn

RATE_HZ = 10
TURN_GAIN = 4.0  # 1/s
SPEED_GAIN = 0.5  # 1/s


def spawn_turtle2():
    rospy.wait_for_service("spawn")
    try:
        rospy.ServiceProxy("spawn", Spawn)(4, 2, 0, "turtle2")
    except rospy.ServiceException as error:
        rospy.logwarn("turtle2 was not spawned: %s", error)  # a second start: it is there


def main():
    rospy.init_node("turtle_tf_listener")
    listener = tf.TransformListener()
    spawn_turtle2()
    publisher = rospy.Publisher("turtle2/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        try:
            (x, y, _), _ = listener.lookupTransform("turtle2", "turtle1", rospy.Time(0))
        except tf.Exception:
            pass  # not both turtles have been seen yet
        else:
            command = Twist()
            command.linear.x = SPEED_GAIN * math.hypot(x, y)
            command.angular.z = TURN_GAIN * math.atan2(y, x)
            publisher.publish(command)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
