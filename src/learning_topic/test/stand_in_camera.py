"""A camera for tests: it sends drawn images, and keeps what a follower answers."""

import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

WIDTH, HEIGHT = 640, 360  # px
LIMIT = 60.0  # s, for everything that is waited for


def wait_until(condition, what, limit=LIMIT):
    """Wait for condition() to become true, and return it; fail with what was waited for."""
    end = time.monotonic() + limit
    while time.monotonic() < end and not rospy.is_shutdown():
        answer = condition()
        if answer:
            return answer
        time.sleep(0.02)
    raise AssertionError(f"not within {limit} s: {what}")


class StandInCamera:
    """Shows a yellow line 11 px wide at `column`; None is a black image, `sends` False is none.

    scale=3 makes the images as large as the waffle's, 1920 x 1080.
    """

    def __init__(self, column, scale=1):
        self.column, self.scale, self.sends = column, scale, True
        self.commands = []
        self.publisher = rospy.Publisher("camera/rgb/image_raw", Image, queue_size=1)
        self.subscriber = rospy.Subscriber("cmd_vel", Twist, self.commands.append)
        threading.Thread(target=self._send, daemon=True).start()

    def next_command(self, wanted, what):
        """The first command from now on that wanted(command) accepts."""
        self.commands.clear()
        return wait_until(lambda: next(filter(wanted, list(self.commands)), None), what)

    def _send(self):
        while not rospy.is_shutdown():
            if self.sends:
                self.publisher.publish(self._image())
            time.sleep(1 / 30)

    def _image(self):
        pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        if self.column is not None:
            pixels[:, self.column - 5 : self.column + 6] = (255, 255, 0)
        pixels = pixels.repeat(self.scale, axis=0).repeat(self.scale, axis=1)
        height, width = pixels.shape[:2]
        msg = Image(height=height, width=width, encoding="rgb8", step=width * 3)
        msg.header.stamp = rospy.Time.now()
        msg.data = pixels.tobytes()
        return msg


def stands(command):
    """Whether this Twist is all zero."""
    return command == Twist()
