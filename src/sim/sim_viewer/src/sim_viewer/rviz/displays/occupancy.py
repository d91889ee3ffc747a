"""rviz/Map: an occupancy grid as an image on the floor, with its updates."""

import zlib
from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import (
    OK,
    WARNING,
    DisplayType,
    Drawer,
    NoTransform,
    Problem,
    View,
)
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import finite, pose_of
from sim_viewer.rviz.options import Option

LARGEST = 4096  # cells per side that are sent: a texture size that every graphics card supports
SCHEMES = ("map", "costmap", "raw")
MOST_CELLS = 1 << 28
MAP_TYPE = "nav_msgs/OccupancyGrid"


class Map(Drawer):
    """The newest map with all updates since; its frame is looked up at each drawing."""

    def __init__(self, options: dict[str, Any]):
        super().__init__(options)
        self._cells: np.ndarray | None = None  # (height, width) int8
        self._part: Part | None = None

    def take(self, message: Any, pose: Pose | None, now: float) -> None:
        """A map or an update; Problem if sizes do not fit."""
        if hasattr(message, "info"):
            self._cells = None  # so that a map that cannot be shown removes the last one
            self._cells, self._place = cells_of(message), pose_of(message.info.origin)
            self._resolution = float(message.info.resolution)
            self._frame = message.header.frame_id
            self.statuses = {"Map": (OK, "Map received")}
        elif self._cells is not None:
            put(self._cells, message)
        self._part = None

    def place_anew(self) -> bool:
        """Each drawing places the map anew."""
        return True

    def restyle(self, options: dict[str, Any]) -> None:
        super().restyle(options)
        self._part = None

    def draw(self, view: View) -> list[Part]:
        """One part; NoTransform if the map's frame has no transform."""
        if self._cells is None:
            self.statuses = {"Map": (WARNING, "No map received")}
            return []
        try:
            place = view.pose(self._frame) * self._place
        except NoTransform:
            raise NoTransform(
                f"No transform from [{self._frame}] to [{view.fixed_frame}]") from None
        self._part = self._part or self._picture()
        self._part.pose = place
        return [self._part]

    def _picture(self) -> Part:
        every = -(-max(self._cells.shape) // LARGEST)
        if every > 1:
            self.statuses["Size"] = (WARNING, f"showing one of {every} x {every} cells")
        shown = np.ascontiguousarray(self._cells[::every, ::every]).view(np.uint8)
        height, width = shown.shape
        size = np.array(self._cells.shape[::-1]) * self._resolution
        return Part("map", {"cells": shown.ravel()}, {
            "width": width, "height": height, "size": size.tolist(),
            "scheme": self.options["Color Scheme"], "alpha": self.options["Alpha"],
            "behind": self.options["Draw Behind"],
        }, key=f"{zlib.crc32(shown):08x}-{width}x{height}")


def cells_of(message: Any) -> np.ndarray:
    """(height, width) int8, the first row at the origin; Problem if sizes do not fit."""
    width, height = message.info.width, message.info.height
    data = np.asarray(message.data, np.int8)
    if not width or not height:
        raise Problem(f"Map is zero-sized ({width}x{height})")
    if width * height != len(data) or len(data) > MOST_CELLS:
        raise Problem(f"Data size doesn't match width*height: width = {width}, height = {height}, "
                      f"data size = {len(data)}")
    if finite([message.info.resolution])[0] <= 0.0:
        raise Problem(f"Map has a resolution of {message.info.resolution:g} m")
    return data.reshape(height, width).copy()


def put(cells: np.ndarray, update: Any) -> None:
    """Write a map_msgs/OccupancyGridUpdate into a map; Problem if it lies outside."""
    height, width = cells.shape
    data = np.asarray(update.data, np.int8)
    if (update.x < 0 or update.y < 0 or update.x + update.width > width
            or update.y + update.height > height):
        raise Problem("Update area outside of original map area.")
    if len(data) != update.width * update.height:
        raise Problem(f"Data size doesn't match width*height: width = {update.width}, "
                      f"height = {update.height}, data size = {len(data)}")
    cells[update.y:update.y + update.height, update.x:update.x + update.width] = (
        data.reshape(update.height, update.width))


TYPE = DisplayType(
    "rviz/Map", Map, messages=(MAP_TYPE,), topic="/map", at_stamp=False, every=True,
    beside="map_msgs/OccupancyGridUpdate", beside_topic=lambda topic: topic + "_updates",
    period=0.1, most_bytes=1 << 29, options=(
        Option("Alpha", "number", 0.7, high=1), Option("Color Scheme", "choice", "map", SCHEMES),
        Option("Draw Behind", "switch", False)))
