#!/usr/bin/env python3
"""Where is the point one metre ahead of the turtle?  海龟正前方一米的点在 world 的哪里？"""

import rospy
import tf2_geometry_msgs  # noqa: F401  lets tf2 transform a PointStamped  让 tf2 认识点消息
import tf2_ros
from geometry_msgs.msg import PointStamped

RATE_HZ = 1


def main():
    rospy.init_node("dynamic_tf_sub")
    buffer = tf2_ros.Buffer()
    tf2_ros.TransformListener(buffer)
    ahead = PointStamped()
    ahead.header.frame_id = "turtle1"
    ahead.header.stamp = rospy.Time(0)  # 0: the latest available transform  0 表示最新的变换
    ahead.point.x = 1.0  # m
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        try:
            point = buffer.transform(ahead, "world").point
            rospy.loginfo("in world: %.2f, %.2f", point.x, point.y)
        except tf2_ros.TransformException as error:
            rospy.logwarn_throttle(10.0, f"not yet: {error}")
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
