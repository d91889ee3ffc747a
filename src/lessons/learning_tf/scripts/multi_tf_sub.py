#!/usr/bin/env python3
"""Transform from one child frame to another, through their parent.  在两个子坐标系之间变换。"""

import rospy
import tf2_geometry_msgs  # noqa: F401  lets tf2 transform a PointStamped  让 tf2 认识点消息
import tf2_ros
from geometry_msgs.msg import PointStamped

RATE_HZ = 1


def main():
    rospy.init_node("multi_tf_sub")
    buffer = tf2_ros.Buffer()
    tf2_ros.TransformListener(buffer)
    point_in_son1 = PointStamped()
    point_in_son1.header.frame_id = "son1"
    point_in_son1.point.x, point_in_son1.point.y, point_in_son1.point.z = 1.0, 2.0, 3.0  # m
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        try:
            # son1 in the frame of son2: target first, source second.  先目标，后源
            origin = buffer.lookup_transform("son2", "son1", rospy.Time(0)).transform.translation
            rospy.loginfo("son1 in son2: %.2f, %.2f, %.2f", origin.x, origin.y, origin.z)
            point = buffer.transform(point_in_son1, "son2").point
            rospy.loginfo("the point in son2: %.2f, %.2f, %.2f", point.x, point.y, point.z)
        except tf2_ros.TransformException as error:
            rospy.logwarn_throttle(10.0, f"not yet: {error}")
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
