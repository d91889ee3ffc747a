#!/usr/bin/env python3
"""Follow, 2 of 3: publish world -> the given turtle.  跟随（二）：发布某只海龟的坐标。"""

import math
import sys

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from turtlesim.msg import Pose


class TurtleFrame:
    def __init__(self, turtle):
        self.turtle = turtle
        self.broadcaster = tf2_ros.TransformBroadcaster()
        rospy.Subscriber(f"/{turtle}/pose", Pose, self.pose_callback, queue_size=1)

    def pose_callback(self, pose):
        transform = TransformStamped()
        transform.header.stamp = rospy.Time.now()
        transform.header.frame_id = "world"
        transform.child_frame_id = self.turtle
        transform.transform.translation.x = pose.x
        transform.transform.translation.y = pose.y
        transform.transform.rotation.z = math.sin(pose.theta / 2)
        transform.transform.rotation.w = math.cos(pose.theta / 2)
        self.broadcaster.sendTransform(transform)


def main():
    words = rospy.myargv(sys.argv)  # without roslaunch's __name:=  去掉 roslaunch 加的参数
    if len(words) != 2:
        sys.exit("demo04_pub.py: which turtle? rosrun learning_tf demo04_pub.py turtle1")
    rospy.init_node("demo04_pub", anonymous=True)  # one node per turtle  每只海龟一个节点
    TurtleFrame(words[1])
    rospy.spin()


if __name__ == "__main__":
    main()
