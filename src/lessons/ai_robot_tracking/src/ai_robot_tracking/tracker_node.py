"""Around visual_tracker_pid.py's law: images in, commands out, a stop whenever that is safer.

An image is usable if it is correctly encoded, not blank, and not frozen.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import cv_bridge
import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image
from std_msgs.msg import Bool

CHANNELS = {"bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4}  # supported encodings, all with colour
FROZEN_TIME = 0.5  # s with the same image while moving
CHECK_PERIOD = 0.1   # s
WARNING_PERIOD = 5   # s
FLUSH_TIME = 0.2     # s, wall: rospy's threads need this to send before the process ends
Command = tuple[float, float]  # m/s; rad/s, left positive


class BadImage(ValueError):
    """One line that says what is wrong with an image."""


class BlankImage(BadImage):
    """All is of one colour: a camera's fault, or the target is all that it sees."""


def decode(encoding: str, width: int, height: int, step: int, data: bytes) -> np.ndarray:
    """The image (height, width, 3), uint8, BGR, from the fields of a sensor_msgs/Image.

    Raises BadImage if encoding, sizes and data are inconsistent.
    """
    channels = CHANNELS.get(encoding)
    if channels is None:
        raise BadImage(f"encoding '{encoding}' is not supported; use one of "
                       f"{', '.join(CHANNELS)}")
    row = width * channels
    if width == 0 or height == 0:
        raise BadImage(f"it is empty: {width} x {height} px")
    if step < row:
        raise BadImage(f"encoding '{encoding}' needs {row} bytes for a row of {width} px, but step "
                       f"is {step}")
    if len(data) != step * height:
        raise BadImage(f"{height} rows of {step} bytes are {step * height} bytes, but there are "
                       f"{len(data)}")
    rows = np.frombuffer(data, np.uint8).reshape(height, step)[:, :row]
    picture = rows.reshape(height, width, channels)[:, :, :3]
    return np.ascontiguousarray(picture if encoding.startswith("bgr") else picture[:, :, ::-1])


class ImageCheck:
    """Checks each image, in order."""

    def __init__(self) -> None:
        self._last: np.ndarray | None = None
        self._same_since = 0.0  # s
        self._frozen = False

    def look(self, picture: np.ndarray, time: float, moving: bool) -> None:
        """`picture` (rows, columns, 3) came at this time, s; `moving`: the robot should move.

        Raises BadImage for an image of a single colour, and for one that has stayed identical, byte
        by byte, for FROZEN_TIME while the robot should move, until a different one comes.
        """
        if self._last is None or not np.array_equal(picture, self._last):
            self._last, self._same_since, self._frozen = picture, time, False
        elif (not moving and not self._frozen) or time < self._same_since:
            self._same_since = time  # a standing robot sees no change, or time was reset
        if (picture == picture[0, 0]).all():
            raise BlankImage("it is blank: every pixel has the same colour")
        self._frozen = self._frozen or time - self._same_since >= FROZEN_TIME
        if self._frozen:
            raise BadImage("it is frozen: the same image again and again while the robot moves")


class TrackerNode:
    """One command on cmd_vel for each image on camera/rgb/image_raw; zero for an unusable one.

    `drive(picture, time)` gets BGR (rows, columns, 3) and s, and returns the command;
    `mark(picture)` draws what was seen, for ~annotated; `fills(picture)`: does it show the target
    and nothing else? `halt()` is called on each stop.
    """

    def __init__(self, image_timeout: float, drive: Callable[[np.ndarray, float], Command],
                 mark: Callable[[np.ndarray, Command], None], fills: Callable[[np.ndarray], bool],
                 halt: Callable[[], None] = lambda: None):
        self.image_timeout = image_timeout
        self._drive, self._mark, self._fills, self._halt = drive, mark, fills, halt
        self._lock = threading.Lock()  # images, e-stop and timer run in different threads
        self._check, self._bridge = ImageCheck(), cv_bridge.CvBridge()
        self._told: Command = (0.0, 0.0)
        self._stopped, self._waiting, self._arrived = False, True, False
        self._stamp, self._fresh = rospy.Time(), rospy.get_time()
        self._commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self._annotated = rospy.Publisher("~annotated", Image, queue_size=1)
        rospy.Subscriber("e_stop", Bool, self._take_stop, queue_size=1)
        self._images = rospy.Subscriber("camera/rgb/image_raw", Image, self._take_image,
                                        queue_size=1, buff_size=2**24)
        self._timer = rospy.Timer(rospy.Duration(CHECK_PERIOD), self._check_images, reset=True)
        rospy.on_shutdown(self._end)

    @property
    def lock(self) -> threading.Lock:
        """Hold this lock while changing anything that `drive` uses."""
        return self._lock

    def _take_image(self, message: Image) -> None:
        with self._lock:
            if self._is_old(message.header.stamp):
                return  # the timeout keeps running
            if rospy.is_shutdown():
                return  # _end() held the lock meanwhile: no command after the final one
            self._stamp, self._fresh = message.header.stamp, rospy.get_time()
            self._waiting = False
            picture = self._look(message)
            command = (0.0, 0.0)
            if picture is not None and not self._stopped:
                command = self._drive(picture, message.header.stamp.to_sec())
            else:
                self._halt()
            self._send(command)
        if picture is not None and self._annotated.get_num_connections() > 0:
            picture = picture.copy()
            self._mark(picture, command)
            self._annotated.publish(self._bridge.cv2_to_imgmsg(picture, "bgr8", message.header))

    def _is_old(self, stamp: rospy.Time) -> bool:
        """Whether the image is not newer than the last one; if much older, time was reset."""
        return bool(stamp) and rospy.Duration() <= self._stamp - stamp < rospy.Duration(1.0)

    def _look(self, message: Image) -> np.ndarray | None:
        """The image; None, with a warning, if it is unusable."""
        try:
            picture = decode(message.encoding, message.width, message.height, message.step,
                             message.data)
            self._check.look(picture, rospy.get_time(), self._told != (0.0, 0.0))
        except BadImage as error:
            if isinstance(error, BlankImage) and self._fills(picture):
                if not self._arrived:
                    rospy.loginfo("arrived: the target fills the image on %s; standing",
                                  self._images.resolved_name)
                self._arrived = True
            else:
                rospy.logwarn_throttle(WARNING_PERIOD, "standing: bad image on %s: %s",
                                       self._images.resolved_name, error)
            return None
        self._arrived = False
        return picture

    def _check_images(self, _event: Any) -> None:
        """Stand still when images stop coming."""
        with self._lock:
            if rospy.get_time() < self._fresh:
                self._fresh = rospy.get_time()  # time was reset
            if rospy.get_time() - self._fresh <= self.image_timeout:
                return
            rospy.logwarn_throttle(WARNING_PERIOD, "standing: no fresh image on %s for %g s",
                                   self._images.resolved_name, self.image_timeout)
            if not self._waiting:
                self._waiting = True
                self._halt()
            self._send((0.0, 0.0))

    def _take_stop(self, message: Bool) -> None:
        """True: stop until false comes, whatever the images show."""
        with self._lock:
            if message.data != self._stopped:
                rospy.logwarn("e-stop: standing" if message.data else "e-stop is over")
            self._stopped = message.data
            if self._stopped:
                self._halt()
                self._send((0.0, 0.0))

    def _send(self, command: Command) -> None:
        message = Twist()
        message.linear.x, message.angular.z = self._told = command
        self._commands.publish(message)

    def _end(self) -> None:
        """Stop the robot for good: no image starts it again."""
        self._timer.shutdown()
        self._images.unregister()
        with self._lock:
            self._send((0.0, 0.0))
        time.sleep(FLUSH_TIME)
