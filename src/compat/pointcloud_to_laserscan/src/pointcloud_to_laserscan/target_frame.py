"""The frame into which both nodes turn points."""

import numpy as np
import rospy
import tf2_ros
from std_msgs.msg import Header

from pointcloud_to_laserscan.projection import rotation

FAR = 2.0e9  # s from now; a process in which tf2 subtracts stamps of 68 years apart is aborted


class TargetFrame:
    """Upstream's ~target_frame and ~transform_tolerance; without a frame points stay in theirs."""

    def __init__(self, least_tolerance: float = 0.0):
        """`least_tolerance`: s that a transform is waited for at least."""
        self.name = rospy.get_param("~target_frame", "").lstrip("/")
        self.tolerance = rospy.Duration(
            max(least_tolerance, rospy.get_param("~transform_tolerance", 0.01)))
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer) if self.name else None

    def turned(self, points: np.ndarray, header: Header) -> np.ndarray:
        """Points (n, 3), m, of the header's frame in this one. Raises TransformException."""
        source = header.frame_id.lstrip("/")
        if self.name in ("", source):
            return points
        ahead = header.stamp.to_sec() - rospy.get_time()
        if "\0" in source or (abs(ahead) > FAR and not header.stamp.is_zero()):
            raise tf2_ros.TransformException(
                f"frame {source!r} at {header.stamp.secs} s cannot be looked up")
        found = self.buffer.lookup_transform(self.name, source, header.stamp,
                                             self.tolerance).transform
        turn, move = found.rotation, found.translation
        return points @ rotation(turn.x, turn.y, turn.z, turn.w).T + [move.x, move.y, move.z]
