#!/usr/bin/env python3
"""Tells tf where a turtle is: world -> the turtle named by ~turtle."""

import sys

import rospy
import tf
from turtlesim.msg import Pose


def main():
    rospy.init_node("turtle_tf_broadcaster")
    turtle = rospy.get_param("~turtle", None)
    if turtle is None:
        sys.exit("turtle_tf_broadcaster.py: which turtle? type: "
                 "rosrun turtle_tf turtle_tf_broadcaster.py _turtle:=turtle1")
    broadcaster = tf.TransformBroadcaster()

    def send(pose):
        turned = tf.transformations.quaternion_from_euler(0, 0, pose.theta)
        broadcaster.sendTransform((pose.x, pose.y, 0), turned, rospy.Time.now(), turtle, "world")

    rospy.Subscriber(f"/{turtle}/pose", Pose, send, queue_size=1)
    rospy.spin()


if __name__ == "__main__":
    main()
