#!/usr/bin/env python3
"""Adds the frame carrot1, which circles turtle1 at 10 m once in two seconds."""

import math

import rospy
import tf

RATE_HZ = 10
RADIUS = 10.0  # m
TURN_RATE = math.pi  # rad/s


def main():
    rospy.init_node("dynamic_tf_broadcaster")
    broadcaster = tf.TransformBroadcaster()
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        angle = TURN_RATE * now.to_sec()
        place = RADIUS * math.sin(angle), RADIUS * math.cos(angle), 0
        broadcaster.sendTransform(place, (0, 0, 0, 1), now, "carrot1", "turtle1")
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
