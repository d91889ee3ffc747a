"""A transform's broadcaster that notices another node which publishes the same one."""

from __future__ import annotations

import time

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

LASTING = 1.0  # s, wall; a node that ends may still send a little beside the one that replaces it


class SoleBroadcaster(tf2_ros.TransformBroadcaster):
    """Logs one line for each other node that moves one of the frames that this node moves.

    A frame has one parent and one place in it: listeners get those of both nodes in turn.
    """

    def __init__(self) -> None:
        super().__init__()
        self._moved: dict[str, str] = {}  # parents by frames
        self._since: dict[str, float] = {}  # when another node was first seen, s, wall
        self._told: set[str] = set()
        for topic, lasting in (("/tf", LASTING), ("/tf_static", 0.0)):
            rospy.Subscriber(topic, TFMessage, self._take, lasting)

    def sendTransform(self, transform: TransformStamped | list[TransformStamped]) -> None:
        """As upstream's."""
        for each in transform if isinstance(transform, list) else [transform]:
            self._moved[each.child_frame_id] = each.header.frame_id
        super().sendTransform(transform)

    def _take(self, message: TFMessage, lasting: float) -> None:
        other = message._connection_header["callerid"]
        if other == rospy.get_name() or other in self._told:
            return
        frame = next((each.child_frame_id for each in message.transforms
                      if each.child_frame_id in self._moved), None)
        now = time.monotonic()
        if frame is None or now - self._since.setdefault(other, now) < lasting:
            return
        self._told.add(other)
        rospy.logwarn("%s and %s both publish the transform from %s to %s, so the robot jumps "
                      "between two places: end one of the two, by Ctrl-C in its launch file's "
                      "terminal or by: rosnode kill %s", rospy.get_name(), other,
                      self._moved[frame], frame, other)
