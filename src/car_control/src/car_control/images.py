"""Arrays from a camera's image messages."""

from __future__ import annotations

import cv_bridge
import numpy as np
import rospy
from sensor_msgs.msg import Image

REPEAT = 5.0  # s between two log lines about unusable messages
_bridge = cv_bridge.CvBridge()


def picture_of(message: Image) -> np.ndarray | None:
    """The image (h, w, 3), uint8, BGR; None, and a log line, if the message is unusable."""
    try:
        picture = _bridge.imgmsg_to_cv2(message, desired_encoding="bgr8")
        why = "it has no pixels"
    except (TypeError, ValueError) as error:  # CvBridgeError; too few bytes, huge sizes
        picture, why = None, " ".join(str(error).split())
    if picture is None:
        rospy.logerr_throttle(REPEAT, f"an image that cannot be used: {why}")
    return picture
