#!/usr/bin/env python3
"""Lesson 1: the ground seen from above.  第一课：把相机图像变成俯视图。"""

import cv2
import cv_bridge
import numpy as np
import rospy
from learning_autorace.ground import (
    calibration_of_parameter,
    compensate,
    find_lane,
    floor_maps,
)
from sensor_msgs.msg import Image


class Projector:
    def __init__(self, calibration):
        self.calibration, self.bridge, self.maps = calibration, cv_bridge.CvBridge(), None
        names = "image_extrinsic_calib", "image_projected", "image_projected_compensated"
        self.topics = [rospy.Publisher(f"camera/{name}", Image, queue_size=1) for name in names]
        rospy.Subscriber("camera/image", Image, self.take, queue_size=1, buff_size=2**24)

    def take(self, message):
        """Publish the area of ground: outlined in the image, from above, and with full contrast."""
        image = self.bridge.imgmsg_to_cv2(message, desired_encoding="bgr8").copy()
        if self.maps is None:
            self.maps = floor_maps(image.shape[1], image.shape[0], self.calibration)
        view = cv2.remap(image, *self.maps, cv2.INTER_LINEAR)
        bright = compensate(view, self.calibration.clip_percent)
        self.say_width(bright)
        border = [np.concatenate((m[0], m[:, -1], m[-1, ::-1], m[::-1, 0])) for m in self.maps]
        cv2.polylines(image, [np.stack(border, 1).astype(np.int32)], True, (0, 0, 255))
        for topic, picture in zip(self.topics, (image, view, bright)):
            topic.publish(self.bridge.cv2_to_imgmsg(picture, "bgr8", header=message.header))

    def say_width(self, view):
        """A check: how wide is the lane in the view?  检查车道宽度。"""
        lane = find_lane(view, 0.0, self.calibration)
        if lane.yellow is None or lane.white is None:
            rospy.logwarn_throttle(2, "no lane ahead of the robot  前方没有车道")
        else:
            width, wanted = lane.yellow - lane.white, self.calibration.lane_width
            rospy.loginfo_throttle(2, f"the lane is {width:.3f} m wide, should be {wanted:.3f} m")


def main():
    rospy.init_node("autorace_calibration")
    Projector(calibration_of_parameter())
    rospy.spin()


if __name__ == "__main__":
    main()
