#!/usr/bin/env python3
"""Transform a point that the radar sees into world.  把雷达坐标系里的点变换到 world。"""

import rospy
import tf2_geometry_msgs  # noqa: F401  lets tf2 transform a PointStamped  让 tf2 认识点消息
import tf2_ros
from geometry_msgs.msg import PointStamped

RATE_HZ = 1


def main():
    rospy.init_node("static_tf_sub")
    buffer = tf2_ros.Buffer()
    tf2_ros.TransformListener(buffer)  # fills the buffer  接收变换并放进 buffer
    seen = PointStamped()
    seen.header.frame_id = "radar"
    seen.point.x, seen.point.y, seen.point.z = 10.0, 2.0, 3.0  # m
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        try:
            point = buffer.transform(seen, "world").point
            rospy.loginfo("in world: %.2f, %.2f, %.2f", point.x, point.y, point.z)
        except tf2_ros.TransformException as error:
            rospy.logwarn_throttle(10.0, f"not yet: {error}")
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
