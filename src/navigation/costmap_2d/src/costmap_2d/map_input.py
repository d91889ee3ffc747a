"""Receives a static layer's map from its topic."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import rospy
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from rospy.numpy_msg import numpy_msg

from nav_algorithms.costmap.layered import LayeredCostmap
from nav_algorithms.costmap.static import StaticLayer, costs_of
from nav_nodes.messages import grid_of
from nav_nodes.missing_data import MissingData, is_published
from nav_nodes.transforms import Transforms


class MapInput:
    """Subscribes to a map; unless the costmap is rolling, it takes the map's size.

    `lock` is the costmap's, as maps come on ROS's thread.
    """

    def __init__(self, values: dict[str, Any], layer: StaticLayer, layered: LayeredCostmap,
                 lock: threading.RLock) -> None:
        """`values`: parameters of params/static_layer.yaml."""
        self._values, self._layer, self._layered, self._lock = values, layer, layered, lock
        self._frame = ""
        self._topic = rospy.resolve_name(values["map_topic"])
        self._subscriber = rospy.Subscriber(self._topic, numpy_msg(OccupancyGridMessage),
                                            self._take, queue_size=1)
        if values["subscribe_to_updates"]:
            rospy.Subscriber(f"{self._topic}_updates", numpy_msg(OccupancyGridUpdate),
                             self._take_update, queue_size=10)

    def has_map(self, missing_data: MissingData) -> bool:
        """Whether a map has come; logs a line if not."""
        what = f"map on {self._topic}"
        if not self._layer.has_map:
            missing_data.missing(what, "start map_server or slam_gmapping, or set map_topic")
            return False
        missing_data.present(what)
        return True

    @property
    def orphaned(self) -> str | None:
        """The map's topic if it is still subscribed to but has no publisher."""
        listens = self._subscriber.impl is not None
        return self._topic if listens and not is_published(self._subscriber) else None

    def place(self, transforms: Transforms, costmap_frame: str) -> None:
        """Sets, in the layer of a rolling costmap, that costmap's pose in the map."""
        if self._layered.rolling and self._frame:
            self._layer.frame_in_map = (np.zeros(3) if self._frame == costmap_frame
                                        else transforms.pose(self._frame, costmap_frame))

    def _take(self, message: OccupancyGridMessage) -> None:
        if self._values["first_map_only"] and self._layer.has_map:
            return
        try:
            grid = grid_of(message)
        except ValueError as error:
            rospy.logwarn_throttle(5.0, "%s: %s", self._topic, error)
            return
        costs = self._costs(grid.cells)
        with self._lock:
            self._frame = message.header.frame_id.lstrip("/")
            layered = self._layered
            if not layered.rolling and not layered.fits(grid.cells.shape, grid.resolution,
                                                        grid.origin):
                layered.resize(grid.cells.shape, grid.resolution, grid.origin)
            self._layer.set_map(grid, costs)
        if self._values["first_map_only"]:
            self._subscriber.unregister()

    def _take_update(self, message: OccupancyGridUpdate) -> None:
        cells = np.asarray(message.data, np.int8)
        try:
            costs = self._costs(cells.reshape(message.height, message.width))
            with self._lock:
                self._layer.change_map(message.y, message.x, costs)
        except ValueError as error:
            rospy.logwarn_throttle(5.0, "%s_updates: %s", self._topic, error)

    def _costs(self, cells: np.ndarray) -> np.ndarray:
        values = self._values
        return costs_of(cells, values["lethal_cost_threshold"], values["unknown_cost_value"],
                        values["trinary_costmap"], values["track_unknown_space"])
