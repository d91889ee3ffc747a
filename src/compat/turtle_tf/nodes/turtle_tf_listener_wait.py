#!/usr/bin/env python3
"""Lets turtle2 follow the frame carrot1; waits each time until tf knows where it is now."""

import math

import rospy
import tf
from geometry_msgs.msg import Twist
from turtlesim.srv import Spawn

RATE_HZ = 10
LONGEST_WAIT = 1.0  # s
TURN_GAIN = 4.0  # 1/s
SPEED_GAIN = 0.5  # 1/s


def spawn_turtle2():
    rospy.wait_for_service("spawn")
    try:
        rospy.ServiceProxy("spawn", Spawn)(4, 2, 0, "turtle2")
    except rospy.ServiceException as error:
        rospy.logwarn("turtle2 was not spawned: %s", error)  # a second start: it is there


def main():
    rospy.init_node("turtle_tf_listener_wait")
    listener = tf.TransformListener()
    spawn_turtle2()
    publisher = rospy.Publisher("turtle2/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        try:
            listener.waitForTransform("turtle2", "carrot1", now, rospy.Duration(LONGEST_WAIT))
            (x, y, _), _ = listener.lookupTransform("turtle2", "carrot1", now)
        except tf.Exception as error:
            rospy.logwarn_throttle(5.0, f"waiting for carrot1 (rosrun turtle_tf "
                                        f"fixed_tf_broadcaster.py publishes it): {error}")
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
