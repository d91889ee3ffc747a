"""A costmap's topics for rviz: whole grids, what changed since, and the robot's outline."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import rospy
from geometry_msgs.msg import Point32, Polygon, PolygonStamped
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from rospy.numpy_msg import numpy_msg

from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.layer import Window
from nav_algorithms.grid import OccupancyGrid
from nav_nodes.messages import grid_message

Grid, Update = numpy_msg(OccupancyGridMessage), numpy_msg(OccupancyGridUpdate)


def _occupancies() -> np.ndarray:
    """What each cost is published as: 0, 1 to 98, 99 inscribed, 100 lethal, -1 unknown."""
    costs = np.arange(256)
    table = np.where(costs > 0, 1 + 97 * (costs - 1) // 251, 0)
    table[[INSCRIBED, LETHAL, UNKNOWN]] = 99, 100, -1
    return table.astype(np.int8)


OCCUPANCIES = _occupancies()


class CostmapPublisher:
    """Publishes below `~NAME/`, and only to somebody. Called on the costmap's thread.

    The grid is latched, but what is latched may be old: who comes new gets the newest first.
    """

    def __init__(self, name: str, frame: str, always_whole: bool,
                 newest: Callable[[], Costmap | None]) -> None:
        """`always_whole`: no updates (always_send_full_costmap); `newest`: a copy, if there is."""
        self._frame, self._always_whole, self._newest = frame, always_whole, newest
        self._sent: Costmap | None = None     # geometry of the newest whole grid
        self._changed: Window | None = None   # since the newest message
        self._somebody_new = False
        self._grid = rospy.Publisher(f"~{name}/costmap", Grid, self, queue_size=1, latch=True)
        self._update = rospy.Publisher(f"~{name}/costmap_updates", Update, queue_size=1)
        self._outline = rospy.Publisher(f"~{name}/footprint", PolygonStamped, queue_size=1)

    def peer_subscribe(self, _topic: str, _publish: Callable, publish_one: Callable) -> None:
        """rospy's listener: somebody new needs a whole grid (on ROS's thread)."""
        costmap = self._newest()
        if costmap is None:
            self._somebody_new = True
        else:
            publish_one(self._whole(costmap))

    def peer_unsubscribe(self, _topic: str, _connections: int) -> None:
        """rospy's listener."""

    def note(self, window: Window | None) -> None:
        """These cells were written."""
        if window is None or self._changed is None:
            self._changed = window or self._changed
            return
        self._changed = tuple(slice(min(old.start, new.start), max(old.stop, new.stop))
                              for old, new in zip(self._changed, window, strict=True))

    def is_wanted(self) -> bool:
        """Somebody came before the first update, and waits for it."""
        return self._somebody_new

    def publish(self, costmap: Costmap) -> None:
        """Sends the whole grid if it moved or is needed, else what was noted since."""
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
        """The outline (K, 2), m, in the costmap's frame."""
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
