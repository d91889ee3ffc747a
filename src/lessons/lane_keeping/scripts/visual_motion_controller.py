#!/usr/bin/env python3
"""The tutorial's lane keeper: mask, sliding windows, two fits, steering towards their middle.

教程的车道保持节点：二值化、滑动窗口、二次拟合，朝两条线的中间转向。改进在 lane_keeping_node.py
"""

import itertools
import time

import cv2
import cv_bridge
import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

ROI_SHARE = 0.5  # share of the image's rows, from the bottom  只看下半幅
OPENING_PX = 5  # px, side of the square of the opening  开运算
WINDOWS, MARGIN_PX = 9, 80  # number of windows; px, half a window's width
MIN_PIXELS = 50  # pixels that move a window; fewer are no line  少于此数不算线
LOOK_AHEAD = 0.7  # share of the region's rows, from the top  预瞄行
STEER_GAIN, MAX_TURN = 2.0, 2.0  # rad/s at an error of half the image's width; rad/s
STRAIGHT_SPEED, BEND_SPEED = 1.0, 0.5  # m/s
BEND_CURVATURE, BEND_ERROR = 0.0005, 0.2  # 1/px; share of half the width: more is a bend
LANE_TOP, LANE_BOTTOM = 0.272, 0.742  # share of the width between the lines  顶行和底行的车道宽度
RED, GREEN, BLUE = (0, 0, 255), (0, 220, 0), (255, 80, 0)  # BGR


def region(image):
    """The rows of an image that are searched.  感兴趣区域。"""
    return image[image.shape[0] - round(ROI_SHARE * image.shape[0]):]


def line_mask(image):
    """255 where a BGR image is darker than its mean: a line, or shade.  比均值暗的地方。"""
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    _, mask = cv2.threshold(grey, float(grey.mean()), 255, cv2.THRESH_BINARY_INV)
    return cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((OPENING_PX, OPENING_PX), np.uint8))


def line_bases(mask):
    """Columns of the left and the right line at the bottom; None: no line.  直方图的两个峰。"""
    histogram = np.count_nonzero(mask[mask.shape[0] // 2:], axis=0)
    histogram = np.convolve(histogram, np.ones(9, int), "same")  # a slanted line is spread
    middle = len(histogram) // 2
    peaks = histogram[:middle].argmax(), middle + histogram[middle:].argmax()
    return [int(peak) if histogram[peak] >= MIN_PIXELS else None for peak in peaks]


def follow_line(mask, base):
    """The line's curve, column = a row^2 + b row + c, and the windows that climbed it.

    滑动窗口自下而上跟着线走，再做二次拟合；没有线时曲线为 None
    """
    centre, windows, found = float(base), [], []
    edges = np.linspace(mask.shape[0], 0, WINDOWS + 1).astype(int)
    for low, high in itertools.pairwise(edges):
        left = max(round(centre) - MARGIN_PX, 0)
        right = min(round(centre) + MARGIN_PX, mask.shape[1])
        windows.append((left, high, right, low))
        pixels = cv2.findNonZero(mask[high:low, left:right])
        if pixels is not None and len(pixels) >= MIN_PIXELS:
            found.append(pixels[:, 0] + [left, high])
            centre = found[-1][:, 0].mean()
    if len(found) < 2:
        return None, windows  # too short to show where the line leads
    columns, rows = np.concatenate(found).T
    return np.polyfit(rows, columns, 2 if len(found) > 3 else 1), windows


def centre_line(left, right, rows, width):
    """The middle of two curves, or half a lane beside the only one; None without.  中线。"""
    left, right = [None if curve is None else np.pad(curve, (3 - len(curve), 0))
                   for curve in (left, right)]
    if left is not None and right is not None:
        return (left + right) / 2
    half = np.array([0.0, (LANE_BOTTOM - LANE_TOP) / rows, LANE_TOP]) * width / 2  # px
    return left + half if left is not None else right - half if right is not None else None


def steer(centre, row, width):
    """Speed (m/s) and turn rate (rad/s, left positive) for a centre line.  速度和转向。"""
    error = np.polyval(centre, row) / (width / 2) - 1  # share of half the width, right positive
    slope = 2 * centre[0] * row + centre[1]
    curvature = abs(2 * centre[0]) / (1 + slope**2) ** 1.5  # 1/px
    bend = curvature > BEND_CURVATURE or abs(error) > BEND_ERROR
    turn = np.clip(-STEER_GAIN * error, -MAX_TURN, MAX_TURN)
    return BEND_SPEED if bend else STRAIGHT_SPEED, float(turn)


def draw(image, windows, curves, row):
    """Windows and curves in the region of an image, and the point to steer to.  画出结果。"""
    for left, high, right, low in windows:
        cv2.rectangle(image, (left, int(high)), (right, int(low)), GREEN, 1)
    rows = np.linspace(0, image.shape[0], 20)
    for curve, colour in zip(curves, (BLUE, BLUE, RED)):
        if curve is not None:
            points = np.stack([np.polyval(curve, rows), rows], axis=1).clip(-4000, 4000)
            cv2.polylines(image, [points.astype(np.int32)], False, colour, 2)
    if curves[2] is not None:
        column = int(np.clip(np.polyval(curves[2], row), -4000, 4000))
        cv2.circle(image, (column, int(row)), 7, RED, -1)


class VisualMotionController:
    def __init__(self):
        self.debug_mode = rospy.get_param("~debug_mode", False)  # do not drive
        self.bridge = cv_bridge.CvBridge()
        self.velocity_publisher = rospy.Publisher("/cmd_vel", Twist, queue_size=10)
        self.image_subscription = rospy.Subscriber(
            "/camera", Image, self.process_and_control, queue_size=1, buff_size=2**24)

    def process_and_control(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, "bgr8").copy()  # to draw into
        road = region(image)
        mask = line_mask(road)
        curves, windows = [], []
        for base in line_bases(mask):
            curve, searched = (None, []) if base is None else follow_line(mask, base)
            curves.append(curve)
            windows += searched
        curves.append(centre_line(*curves, *mask.shape))
        row = LOOK_AHEAD * mask.shape[0]
        command = Twist()  # zero, for no lane
        if self.debug_mode:
            rospy.loginfo_throttle(2, "debug mode: standing  调试模式：运动已暂停")
        elif curves[2] is not None:
            command.linear.x, command.angular.z = steer(curves[2], row, mask.shape[1])
        self.velocity_publisher.publish(command)
        cv2.imshow("ROI", road.copy())
        cv2.imshow("ROI-II", mask)
        draw(road, windows, curves, row)
        cv2.imshow("Lane Detection", image)
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
