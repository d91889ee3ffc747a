"""A costmap's topics for rviz: complete grids, updates, and the robot's footprint."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import rospy
from geometry_msgs.msg import Point32, Polygon, PolygonStamped
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from rospy.numpy_msg import numpy_msg

from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.layer import Window
from nav_nodes.messages import grid_message

Grid, Update = numpy_msg(OccupancyGridMessage), numpy_msg(OccupancyGridUpdate)


def _occupancies() -> np.ndarray:
    """Published value of each cost: 0, 1 to 98, 99 inscribed, 100 lethal, -1 unknown."""
    costs = np.arange(256)
    table = np.where(costs > 0, 1 + 97 * (costs - 1) // 251, 0)
    table[[INSCRIBED, LETHAL, UNKNOWN]] = 99, 100, -1
    return table.astype(np.int8)


OCCUPANCIES = _occupancies()


class CostmapPublisher:
    """Publishes below `~NAME/`, if there are subscribers. Called on the costmap's thread.

    The latched grid may be outdated, so a new subscriber is sent the newest one first.
    """

    def __init__(self, name: str, frame: str, always_whole: bool,
                 newest: Callable[[], Costmap | None]) -> None:
        """`always_whole`: always_send_full_costmap; `newest` gives a copy of the costmap."""
        self._frame, self._always_whole, self._newest = frame, always_whole, newest
        self._sent: Costmap | None = None     # the newest complete grid, for its geometry
        self._changed: Window | None = None   # since the newest message
        self._somebody_new = False
        self._grid = rospy.Publisher(f"~{name}/costmap", Grid, self, queue_size=1, latch=True)
        self._update = rospy.Publisher(f"~{name}/costmap_updates", Update, queue_size=1)
        self._outline = rospy.Publisher(f"~{name}/footprint", PolygonStamped, queue_size=1)

    def peer_subscribe(self, _topic: str, _publish: Callable, publish_one: Callable) -> None:
        """rospy's listener: sends a new subscriber a complete grid (on ROS's thread)."""
        costmap = self._newest()
        if costmap is None:
            self._somebody_new = True
        else:
            publish_one(self._whole(costmap))

    def peer_unsubscribe(self, _topic: str, _connections: int) -> None:
        """rospy's listener."""

    def note(self, window: Window | None) -> None:
        """Take note that these cells were written."""
        if window is None or self._changed is None:
            self._changed = window or self._changed
            return
        self._changed = tuple(slice(min(old.start, new.start), max(old.stop, new.stop))
                              for old, new in zip(self._changed, window, strict=True))

    def is_wanted(self) -> bool:
        """Whether a subscriber from before the first update waits for a grid."""
        return self._somebody_new

    def publish(self, costmap: Costmap) -> None:
        """Publish the complete grid if it moved or is needed, else the noted cells."""
        if not self._grid.get_num_connections() and not self._update.get_num_connections():
            self._sent = None
            return
        changed, self._changed = self._changed, None
        if self._somebody_new or self._always_whole or not self._is_as_sent(costmap):
            self._somebody_new = False
            self._sent = costmap
            self._grid.publish(self._whole(costmap))
        elif changed is not None:
            cells = OCCUPANCIES[costmap.cells[changed]]
            message = Update(x=changed[1].start, y=changed[0].start, width=cells.shape[1],
                             height=cells.shape[0], data=cells.ravel())
            message.header.stamp, message.header.frame_id = rospy.Time.now(), self._frame
            self._update.publish(message)

    def publish_footprint(self, corners: np.ndarray) -> None:
        """Publish the footprint (K, 2), m, in the costmap's frame."""
        if not self._outline.get_num_connections():
            return
        message = PolygonStamped(polygon=Polygon([Point32(x, y, 0.0) for x, y in corners.tolist()]))
        message.header.stamp, message.header.frame_id = rospy.Time.now(), self._frame
        self._outline.publish(message)

    def _whole(self, costmap: Costmap) -> OccupancyGridMessage:
        grid = OccupancyGrid(OCCUPANCIES[costmap.cells], costmap.resolution, costmap.origin)
        message = grid_message(grid, self._frame, rospy.Time.now())
        return Grid(message.header, message.info, message.data)

    def _is_as_sent(self, costmap: Costmap) -> bool:
        sent = self._sent
        return (sent is not None and sent.cells.shape == costmap.cells.shape
                and sent.resolution == costmap.resolution
                and tuple(sent.origin) == tuple(costmap.origin))
