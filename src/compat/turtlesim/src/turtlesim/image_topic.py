"""The pond's picture as the topic ~image, for machines without a screen."""

from __future__ import annotations

import numpy as np
import rospy
from sensor_msgs.msg import Image


class ImageTopic:
    """Make it after rospy.init_node."""

    closed = False

    def __init__(self) -> None:
        self._publisher = rospy.Publisher("~image", Image, queue_size=1)
        self.name = self._publisher.resolved_name

    @property
    def wanted(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def show(self, picture: np.ndarray) -> None:
        """(height, width, 3) uint8 RGB."""
        message = picture_to_msg(picture)
        message.header.stamp = rospy.Time.now()
        self._publisher.publish(message)


def picture_to_msg(picture: np.ndarray) -> Image:
    """(height, width, 3) uint8 RGB to an rgb8 image without a stamp."""
    height, width = picture.shape[:2]
    return Image(height=height, width=width, encoding="rgb8", step=3 * width,
                 data=picture.tobytes())
