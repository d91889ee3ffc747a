#!/usr/bin/env python3
"""The tutorial's lane keeper: mask, sliding windows, two fits, steering towards their middle.

教程的车道保持节点：二值化、滑动窗口、二次拟合，朝两条线的中间转向。改进在 lane_keeping_node.py
"""

import time

import cv2
import cv_bridge
import rospkg
import rospy
from geometry_msgs.msg import Twist
from lane_keeping.annotate import annotate
from lane_keeping.binarise import line_mask, region
from lane_keeping.lane_keeper import LANE, LOST, Decision
from lane_keeping.methods import sliding_windows
from lane_keeping.road_view import road_view
from lane_keeping.settings import load_settings
from sensor_msgs.msg import Image

PAGE = rospkg.RosPack().get_path("lane_keeping") + "/config/page.yaml"


class VisualMotionController:
    def __init__(self):
        self.settings = load_settings(PAGE)
        self.debug_mode = rospy.get_param("~debug_mode", False)  # do not drive
        self.bridge = cv_bridge.CvBridge()
        self.velocity_publisher = rospy.Publisher("/cmd_vel", Twist, queue_size=10)
        self.image_subscription = rospy.Subscriber(
            "/camera", Image, self.process_and_control, queue_size=1, buff_size=2**24)

    def process_and_control(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, "bgr8")
        mask = line_mask(image, self.settings)
        view = road_view(self.settings, msg.width, msg.height)
        plan = sliding_windows.plan(mask, view, self.settings)
        command = Twist()  # zero, for no lane
        if self.debug_mode:
            rospy.loginfo_throttle(2, "debug mode: standing  调试模式：运动已暂停")
        elif plan is not None:
            command.linear.x, command.angular.z = plan.speed, plan.turn
        self.velocity_publisher.publish(command)
        seen = Decision(LANE if plan else LOST, command.linear.x, command.angular.z, plan, view)
        cv2.imshow("ROI", region(image, self.settings.roi_share))
        cv2.imshow("ROI-II", mask)
        cv2.imshow("Lane Detection", annotate(image.copy(), seen))
        cv2.waitKey(1)  # ms

    def stop(self):
        self.image_subscription.unregister()  # else the next image would start the car again
        self.velocity_publisher.publish(Twist())
        time.sleep(0.2)  # s, wall: sending takes time


def main():
    rospy.init_node("visual_motion_controller")
    controller = VisualMotionController()
    rospy.on_shutdown(controller.stop)
    rospy.spin()


if __name__ == "__main__":
    main()
