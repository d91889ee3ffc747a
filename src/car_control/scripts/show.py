#!/usr/bin/env python3
"""Shows the car's camera in a window.  在窗口里显示小车的相机图像。"""

import threading

import cv2
import rospy
from car_control.images import picture_of
from sensor_msgs.msg import Image

WINDOW = "SHOW"
QUIT_KEYS = (ord("q"), 27)  # 27: Esc
KEY_WAIT_MS = 5


class Camera:
    """Keeps the newest image for the main thread, which must do all window calls."""

    def __init__(self):
        self.msg = None
        self.arrived = threading.Event()
        self.image_sub = rospy.Subscriber(
            "/camera/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        self.msg = msg
        self.arrived.set()

    def next_image(self):
        """The newest image as BGR; None if none came for a moment, or it was unusable."""
        if not self.arrived.wait(KEY_WAIT_MS / 1000):
            return None
        self.arrived.clear()
        return picture_of(self.msg)


def is_closed():
    """Whether the user closed the window.  窗口是否已被关闭。"""
    return cv2.getWindowProperty(WINDOW, cv2.WND_PROP_VISIBLE) < 1


def main():
    rospy.init_node("camera", anonymous=True)
    camera = Camera()
    cv2.namedWindow(WINDOW, cv2.WINDOW_NORMAL)
    while not rospy.is_shutdown():
        image = camera.next_image()
        if image is not None:
            cv2.imshow(WINDOW, image)
        if cv2.waitKey(1) & 0xFF in QUIT_KEYS or is_closed():
            break
    cv2.destroyAllWindows()


if __name__ == "__main__":
    main()
