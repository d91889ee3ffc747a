#!/usr/bin/env python3
"""Lets turtle2 follow the frame carrot1; waits each time until tf2 knows where it is now."""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import Twist
from turtlesim.srv import Spawn

RATE_HZ = 10
LONGEST_WAIT = rospy.Duration(1.0)
TURN_GAIN = 4.0  # 1/s
SPEED_GAIN = 0.5  # 1/s


def spawn(turtle):
    rospy.wait_for_service("spawn")
    try:
        rospy.ServiceProxy("spawn", Spawn)(4, 2, 0, turtle)
    except rospy.ServiceException as error:
        rospy.logwarn("%s was not spawned: %s", turtle, error)  # a second start: it is there


def command_to(place):
    command = Twist()
    command.linear.x = SPEED_GAIN * math.hypot(place.x, place.y)
    command.angular.z = TURN_GAIN * math.atan2(place.y, place.x)
    return command


def main():
    rospy.init_node("tf2_turtle_listener")
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)  # fills the buffer while it lives
    follower = rospy.get_param("turtle", "turtle2")
    spawn(follower)
    publisher = rospy.Publisher(f"{follower}/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        try:
            found = buffer.lookup_transform(follower, "carrot1", rospy.Time.now(), LONGEST_WAIT)
        except tf2_ros.TransformException as error:
            rospy.logwarn_throttle(5.0, f"waiting for carrot1 (rosrun turtle_tf2 "
                                        f"fixed_tf2_broadcaster.py publishes it): {error}")
        else:
            publisher.publish(command_to(found.transform.translation))
        rate.sleep()
    listener.unregister()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
