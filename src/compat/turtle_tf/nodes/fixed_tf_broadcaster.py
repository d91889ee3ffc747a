#!/usr/bin/env python3
"""Adds the frame carrot1, 2 m to the left of turtle1."""

import rospy
import tf

RATE_HZ = 10


def main():
    rospy.init_node("fixed_tf_broadcaster")
    broadcaster = tf.TransformBroadcaster()
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        broadcaster.sendTransform((0, 2, 0), (0, 0, 0, 1), rospy.Time.now(), "carrot1", "turtle1")
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
