#!/usr/bin/env python3
"""Drives turtle3 in a circle and publishes its place in the frame world, as a sensor would."""

import rospy
from geometry_msgs.msg import PointStamped, Twist
from turtlesim.msg import Pose
from turtlesim.srv import Spawn

RATE_HZ = 10
SPEED = 1.0  # m/s
TURN_RATE = 1.0  # rad/s


def main():
    rospy.init_node("tf2_turtle_stamped_msg_publisher")
    rospy.wait_for_service("spawn")
    try:
        rospy.ServiceProxy("spawn", Spawn)(4, 2, 0, "turtle3")
    except rospy.ServiceException as error:
        rospy.logwarn("turtle3 was not spawned: %s", error)  # a second start: it is there
    points = rospy.Publisher("turtle_point_stamped", PointStamped, queue_size=1)

    def publish_point(pose):
        point = PointStamped()
        point.header.stamp, point.header.frame_id = rospy.Time.now(), "world"
        point.point.x, point.point.y = pose.x, pose.y
        points.publish(point)

    rospy.Subscriber("turtle3/pose", Pose, publish_point, queue_size=1)
    commands = rospy.Publisher("turtle3/cmd_vel", Twist, queue_size=1)
    circle = Twist()
    circle.linear.x, circle.angular.z = SPEED, TURN_RATE
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        commands.publish(circle)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting
