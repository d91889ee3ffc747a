#!/usr/bin/env python3
"""The tutorial's first node: shows the camera's images and counts them, but does not use them.

教程的第一个节点：显示图像并计数，直行 100 帧，左转 60 帧，如此反复
"""

import time

import cv2
import cv_bridge
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

AHEAD, LEFT = 100, 60  # images
SPEED, BEND_SPEED, TURN = 1.0, 0.5, 0.5  # m/s, m/s, rad/s


class LearningNode:
    def __init__(self):
        self.count = 0
        self.bridge = cv_bridge.CvBridge()
        self.velocity_publisher = rospy.Publisher("/cmd_vel", Twist, queue_size=10)
        self.image_subscription = rospy.Subscriber(
            "/camera", Image, self.take_image, queue_size=1, buff_size=2**24)

    def take_image(self, msg):
        cv2.imshow("img", self.bridge.imgmsg_to_cv2(msg, "bgr8"))
        cv2.waitKey(1)  # ms
        command = Twist()
        if self.count % (AHEAD + LEFT) < AHEAD:
            command.linear.x = SPEED
        else:
            command.linear.x, command.angular.z = BEND_SPEED, TURN
        self.count += 1
        self.velocity_publisher.publish(command)

    def stop(self):
        self.image_subscription.unregister()  # else the next image would start the car again
        self.velocity_publisher.publish(Twist())
        time.sleep(0.2)  # s, wall: sending takes time


def main():
    rospy.init_node("learning_node")
    rospy.on_shutdown(LearningNode().stop)
    rospy.spin()


if __name__ == "__main__":
    main()
