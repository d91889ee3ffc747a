"""Hands on the camera's images, as they are or spoiled, and knows how the car moves."""

import copy
import threading
import time

import rospy
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Image

LIMIT = 60.0  # s, wall
GOOD, BLANK, FROZEN, WRONG_STEP, NONE = "good", "blank", "frozen", "step", "no fresh image"


def wait_until(condition, what):
    """Returns when it is true; AssertionError after LIMIT."""
    until = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > until:
            raise AssertionError(f"{what}: not within {LIMIT:g} s")
        time.sleep(0.01)


class SpoilingRelay:
    """`mode` says what happens to images from /camera/rgb/image_raw to /relay/image_raw."""

    def __init__(self):
        self.mode, self._frozen = GOOD, None
        self.speed, self.turn, self.time = 0.0, 0.0, 0.0  # m/s, rad/s, s of the newest pose
        self.said = []  # (node, text) of warnings
        self._lock = threading.Lock()
        self._publisher = rospy.Publisher("/relay/image_raw", Image, queue_size=1)
        rospy.Subscriber("/camera/rgb/image_raw", Image, self._hand_on, queue_size=1,
                         buff_size=2**22)
        rospy.Subscriber("/ground_truth", Odometry, self._see, queue_size=1)
        rospy.Subscriber("/rosout", Log, self._hear)

    @property
    def moves(self):
        return abs(self.speed) > 0.03 or abs(self.turn) > 0.05

    @property
    def stands(self):
        return abs(self.speed) < 0.01 and abs(self.turn) < 0.02

    def spoil(self, mode):
        """From the next image on."""
        with self._lock:
            self.mode, self._frozen = mode, None

    def warnings(self, words):
        """Those texts in which all of these words stand."""
        return [text for text in self.said if all(word in text for word in words)]

    def _hear(self, message):
        if message.level >= Log.WARN:
            self.said.append(message.msg)

    def _see(self, message):
        motion = message.twist.twist
        self.speed = (motion.linear.x**2 + motion.linear.y**2) ** 0.5
        self.turn, self.time = motion.angular.z, message.header.stamp.to_sec()

    def _hand_on(self, message):
        with self._lock:
            mode = self.mode
            if mode == NONE:
                return
            if mode == FROZEN:
                self._frozen = self._frozen or message.data
                message = copy.copy(message)
                message.data = self._frozen
            elif mode == BLANK:
                message.data = b"\x80" * len(message.data)
            elif mode == WRONG_STEP:
                message.step //= 3
        self._publisher.publish(message)
