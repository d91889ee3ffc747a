#!/usr/bin/env python3
"""Drives up to the largest red object in sight, with the tutorial's plain P controller.

朝视野里最大的红色物体开过去：教程里的比例控制。

It never stops before the target; it stands while images are unusable, and at the end.
它不会在目标前停下；图像异常时和结束时会停车。
"""

import sys
import threading
import time
from types import SimpleNamespace

import cv2
import cv_bridge
import rospy
from geometry_msgs.msg import Twist
from rospy.client import load_command_line_node_params
from sensor_msgs.msg import Image
from std_msgs.msg import Bool

CHANNELS = {"bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4}  # encodings with colours
PAGE = {  # the page's numbers; parameters of these names replace them  教程里的数值，可用参数替换
    "hue_low": 0, "hue_high": 10, "saturation_low": 100, "value_low": 100,  # of 180, 255, 255
    "least_radius": 10,  # px; smaller is too small to drive to  太小，不开过去
    "turn_gain": 0.005,  # rad/s per px from the middle
    "straight_error": 50, "near_radius": 30, "far_radius": 25,  # px; less error: straight ahead
    # m/s: ahead and larger than near_radius; smaller than far_radius; otherwise
    "fast_speed": 0.2, "far_speed": 0.15, "slow_speed": 0.1,
    "search_turn": 0.5, "small_turn": 0.3,  # rad/s; nothing red, or too small  看不到、太小时的转速
    "image_timeout": 0.5}  # s without a new image until it stops  图像中断则停车


def read_parameters():
    """The page's numbers; the launch file's ~file and _NAME:=VALUE replace them.  读参数"""
    given = rospy.get_param("~", {})
    for name in load_command_line_node_params(sys.argv):
        rospy.delete_param(f"~{name}")  # _NAME:=VALUE is for one run  只对这一次运行有效
    try:
        file = given.pop("file", {"visual_tracker": {}})
        if "visual_tracker" not in file:
            rospy.logwarn("the file of parameters has no section visual_tracker: the page's "
                          "numbers are used")
        given = file.get("visual_tracker", {}) | given
    except (AttributeError, TypeError):  # a single value in place of all of them  不是一组参数
        given = {"~": given}
    wrong = [name for name in given if name not in PAGE or type(given[name]) not in (int, float)]
    if wrong:
        rospy.delete_param("~")  # else refused again, once the file is right  否则改好后仍会报错
        rospy.logfatal("unknown parameter, or no number: '%s'; known: %s", wrong[0], [*PAGE])
        sys.exit(1)
    return SimpleNamespace(**PAGE | given)


def red_mask(picture, p):
    """255 where a BGR image is red, else 0; eroded and dilated, so that specks vanish.  红色掩膜"""
    hsv = cv2.cvtColor(picture, cv2.COLOR_BGR2HSV)
    mask = cv2.inRange(hsv, (p.hue_low, p.saturation_low, p.value_low), (p.hue_high, 255, 255))
    return cv2.dilate(cv2.erode(mask, None, iterations=2), None, iterations=2)


def largest_circle(mask):
    """Column, row and radius (px) of the circle round the largest blob; or None.  最大的红色物体"""
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    if not contours:
        return None
    (column, row), radius = cv2.minEnclosingCircle(max(contours, key=cv2.contourArea))
    return column, row, radius


def command_to(circle, width, p):
    """Speed (m/s) and turn rate (rad/s, left positive); `width`: of the image, px.  怎么走"""
    if circle is None:
        return 0.0, p.search_turn
    column, _row, radius = circle
    if radius <= p.least_radius:
        return 0.0, p.small_turn
    error = column - width / 2  # px, positive on the right
    if abs(error) < p.straight_error and radius > p.near_radius:
        speed = p.fast_speed
    elif radius < p.far_radius:
        speed = p.far_speed
    else:
        speed = p.slow_speed
    return speed, -p.turn_gain * error


class VisualTracker:
    def __init__(self, p):
        self.p, self.bridge = p, cv_bridge.CvBridge()
        self.lock = threading.Lock()  # images, e-stop and timer run in different threads
        self.circle, self.stopped, self.arrival = None, False, rospy.get_time()
        self.commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.annotated = rospy.Publisher("~annotated", Image, queue_size=1)
        rospy.Subscriber("e_stop", Bool, self.e_stop_callback, queue_size=1)
        self.images = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24)
        self.timer = rospy.Timer(rospy.Duration(0.1), self.check_images, reset=True)
        rospy.on_shutdown(self.stop)

    def image_callback(self, msg):
        row = msg.width * CHANNELS.get(msg.encoding, 0)  # bytes
        if not 0 < row <= msg.step or len(msg.data) != msg.step * msg.height:
            self.warn(f"bad image: '{msg.encoding}' does not fit its size and step {msg.step}")
            return  # check_images will stop the car  之后由 check_images 停车
        picture = self.bridge.imgmsg_to_cv2(msg, "bgr8").copy()  # to draw into
        with self.lock:
            self.arrival = rospy.get_time()
            if not self.stopped and not rospy.is_shutdown():  # else stop() has sent the last one
                self.send(*self.drive(picture))
        if self.annotated.get_num_connections() > 0:
            if self.circle is not None:
                column, row, radius = map(round, self.circle)
                cv2.circle(picture, (column, row), radius, (0, 255, 255), 2)
            self.annotated.publish(self.bridge.cv2_to_imgmsg(picture, "bgr8", msg.header))

    def drive(self, picture):
        """Speed (m/s) and turn rate (rad/s) for a picture; zero if it is of one colour.  怎么走"""
        mask, before = red_mask(picture, self.p), self.circle
        self.circle = largest_circle(mask)
        if (picture == picture[0, 0]).all():
            if mask.all():
                rospy.loginfo_once("arrived: the target fills the image; standing")
            else:
                self.warn("bad image: it is blank: every pixel has the same colour")
            return 0.0, 0.0
        if (before is None) != (self.circle is None):
            rospy.loginfo("target in sight" if self.circle else "nothing red in sight: turning")
        return command_to(self.circle, picture.shape[1], self.p)

    def check_images(self, _event):
        """Stand still when images stop coming.  图像中断时停车"""
        with self.lock:
            if not 0 <= rospy.get_time() - self.arrival <= self.p.image_timeout:
                self.warn("no fresh image")
                self.send(0.0, 0.0)

    def warn(self, fault):
        rospy.logwarn_throttle(5, "standing: %s on %s", fault, self.images.resolved_name)

    def e_stop_callback(self, msg):
        """True: stand until false comes, whatever the images show.  急停"""
        rospy.logwarn("e-stop: standing" if msg.data else "e-stop is over")
        with self.lock:
            self.stopped = msg.data
            self.send(0.0, 0.0)

    def send(self, speed, turn):
        command = Twist()
        command.linear.x, command.angular.z = speed, turn
        self.commands.publish(command)

    def stop(self):
        """Stop before exiting.  退出前停车"""
        self.timer.shutdown()
        self.images.unregister()  # else the next image would start the car again
        with self.lock:
            self.send(0.0, 0.0)
        time.sleep(0.2)  # s, wall: sending takes time


def main():
    rospy.init_node("visual_tracker")
    VisualTracker(read_parameters())
    rospy.spin()


if __name__ == "__main__":
    main()
