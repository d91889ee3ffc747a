#!/usr/bin/env python3
"""Follow, 3 of 3: turtle2 drives towards turtle1.  跟随（三）：turtle2 追 turtle1。"""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import Twist

RATE_HZ = 10
DRIVE_GAIN = 0.5  # m/s per m of distance
TURN_GAIN = 4.0  # rad/s per rad of bearing
WAIT = rospy.Duration(3.0)  # for the frames, at the start  开始时等待坐标变换


def follow(x, y):
    """Drive towards a target x m ahead and y m to the left.  目标在前方 x、左方 y 米处。"""
    command = Twist()
    command.linear.x = DRIVE_GAIN * math.hypot(x, y)
    command.angular.z = TURN_GAIN * math.atan2(y, x)
    return command


def main():
    rospy.init_node("demo04_sub")
    buffer = tf2_ros.Buffer()
    tf2_ros.TransformListener(buffer)
    publisher = rospy.Publisher("/turtle2/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        try:
            # turtle1 in the frame of turtle2.  turtle1 在 turtle2 坐标系中的位置
            target = buffer.lookup_transform("turtle2", "turtle1", rospy.Time(0), WAIT)
            publisher.publish(follow(target.transform.translation.x,
                                     target.transform.translation.y))
        except tf2_ros.TransformException as error:
            rospy.logwarn_throttle(10.0, f"not yet: {error}")
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
