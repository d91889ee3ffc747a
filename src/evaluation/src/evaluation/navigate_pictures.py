"""run.mp4: camera beside map, scan, plan and path; map.png: map, true walls, all paths, goals."""

from __future__ import annotations

import contextlib
import threading
from pathlib import Path

import cv2
import numpy as np
import rospy
from cv_bridge import CvBridge
from sensor_msgs.msg import Image

from evaluation.film import LONGEST_GAP, FilmFile, fit, side_by_side
from evaluation.house import Records, Watch
from evaluation.navigate_score import Result
from evaluation.picture import (
    CAR,
    FLOOR,
    MAP_PX,
    TEXT,
    Plan,
    bgr,
    lap_colour,
    sheet,
    write_text,
)
from nav_algorithms.cells import FREE, OCCUPIED, OccupancyGrid
from nav_algorithms.poses import compose, transform_points
from trial_worlds.house import Ground

CAMERA = "/camera/rgb/image_raw"
LASER = np.array([-0.064, 0.0, 0.0])  # in base_footprint
PERIOD = 1.0  # s, simulated, between two frames: the video runs at ten times the speed
LOOK_PERIOD, VIEW_TIME = 0.1, 1.0  # s, wall; the latter to wait for a camera image
PLAN_PX = 760
SCAN, PLANNED, DRIVEN = "#ff5050", "#fae65a", lap_colour(0)
CLEAR, TRUE_WALL, GOAL = "#363a42", "#3cbe78", "#fac846"
OCCUPIED_FROM = 50  # percent
PATHS = (("mapping", "driven while mapping", lap_colour(0)),
         ("goals", "driven to the goals", lap_colour(3)))


class Film(FilmFile):
    """Adds a frame every PERIOD (s, simulated) during a part of the run."""

    def __init__(self, path: Path, ground: Ground, watch: Watch, result: Result):
        super().__init__(path)
        self.title = ""  # what the run is doing now
        self._watch, self._result = watch, result
        self._floor = _floor(ground, PLAN_PX)
        self._view: Image | None = None
        self._records: Records | None = None
        self._number = -1
        self._thread = threading.Thread(target=self._film, daemon=True, name="film")

    def start(self) -> None:
        """Begin to record."""
        self._thread.start()

    def close(self) -> str:
        """Finish the file, if it has any frame; returns why it is incomplete, or ""."""
        self.stop()
        if self._thread.ident is not None:
            self._thread.join()
        return super().close()

    def _film(self) -> None:
        while not self._ended.wait(LOOK_PERIOD):
            records = self._watch.records
            if records is not self._records:
                self._records, self._number = records, -1
            number, last = int(records.now / PERIOD), self._number
            if records.truth and number > last:
                self._number = number
                # Only one image: while subscribed to, the camera renders thirty a second.
                with contextlib.suppress(rospy.ROSException):
                    self._view = rospy.wait_for_message(CAMERA, Image, VIEW_TIME)
                # The video keeps simulated time even where images are missing.
                self._add(self._page(records), 1 if last < 0 else min(number - last, LONGEST_GAP))

    def _page(self, records: Records) -> np.ndarray:
        view = self._view and fit(CvBridge().imgmsg_to_cv2(self._view, "bgr8"))
        words = {12: self.title, 660: f"{records.now:6.1f} s   {records.length:6.1f} m   touched"
                                      f" {len(records.contacts)}"}
        return side_by_side(view, self._plan(records), words, PERIOD)

    def _plan(self, records: Records) -> np.ndarray:
        """The current map with scan, plan and the path driven."""
        watch, plan, there = self._watch, self._floor.copy(), self._result.map_in_world
        grid, hits = watch.map, watch.hits  # kept: other threads may reset the attributes
        if grid is not None:
            _lay_cells(plan, grid, there)
        plan.line(np.array(records.truth).reshape(-1, 4)[:, 1:3], DRIVEN, 2)
        plan.line(transform_points(there, watch.plan), PLANNED, 2)
        if hits is not None and records.believed:
            laser = compose(compose(there, records.believed_pose), LASER)
            plan.dots(transform_points(laser, hits), SCAN)
        plan.arrow(records.true_pose, 0.38, CAR)
        return plan.image


def _floor(ground: Ground, width_px: int) -> Plan:
    low = np.array(ground.walls.origin)
    high = low + np.array(ground.walls.cells.shape[::-1]) * ground.walls.resolution
    return Plan(low - 0.2, high + 0.2, width_px)


def _lay_cells(plan: Plan, grid: OccupancyGrid, grid_in_world: np.ndarray) -> None:
    """Draw the map's cells; unknown ones have the floor's colour."""
    cells = np.full((*grid.cells.shape, 3), bgr(FLOOR), np.uint8)
    cells[(grid.cells >= FREE) & (grid.cells < OCCUPIED_FROM)] = bgr(CLEAR)
    cells[grid.cells >= OCCUPIED_FROM] = bgr(TEXT)
    plan.image = _laid(plan, cells, grid, grid_in_world, bgr(FLOOR))


def _laid(plan: Plan, cells: np.ndarray, grid: OccupancyGrid, grid_in_world: np.ndarray,
          border: object = 0) -> np.ndarray:
    """One value or colour for each of the grid's cells, as the plan's pixels."""
    # The middle of pixel (0, 0) of the cells lies half a cell inside the grid.
    corners = np.array([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0)])
    points = (corners + 0.5) * grid.resolution + grid.origin
    there = plan.to_px(transform_points(np.asarray(grid_in_world), points)) - 0.5
    turn = cv2.getAffineTransform(corners.astype(np.float32), there.astype(np.float32))
    return cv2.warpAffine(cells, turn, plan.image.shape[1::-1], flags=cv2.INTER_NEAREST,
                          borderValue=border)


def map_picture(ground: Ground, result: Result, title: str, subtitle: str) -> np.ndarray:
    """The picture (rows, 1400, 3), BGR."""
    plan, walls = _floor(ground, MAP_PX), ground.walls
    if result.map is not None:
        _lay_cells(plan, result.map, result.map_in_world)
    plan.grid(1.0)
    standing = _laid(plan, (walls.cells == OCCUPIED).astype(np.uint8), walls, np.zeros(3))
    edges, _ = cv2.findContours(standing, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(plan.image, edges, -1, bgr(TRUE_WALL))
    for part, _, colour in PATHS:
        plan.line(result.paths.get(part, ()), colour, 3)
    ways = result.navigation["goals"] if result.navigation else []
    for number, way in enumerate(ways, start=1):
        goal = np.array([way["x"], way["y"], np.radians(way["yaw_deg"])])
        ends = transform_points(goal, np.array([(0.0, 0.0), (0.4, 0.0)]))
        colour = GOAL if way["reached"] else CAR
        plan.line(ends, colour, 3)
        plan.disc(ends[0], 8 / plan.px_per_m, colour, thick_px=2)
        x, y = plan.to_px(ends)[0].astype(int).tolist()
        write_text(plan.image, str(number), (x + 14, y - 11), 11)
    return sheet((title, subtitle), [plan], [
        ("true wall", TRUE_WALL), *((text, colour) for _, text, colour in PATHS), ("goal", GOAL),
        ("not reached", CAR)])
