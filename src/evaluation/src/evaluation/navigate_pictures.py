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
from evaluation.picture import CAR, FLOOR, TEXT, Plan, bgr, lap_colour, legend, map_sheet, pixels
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
        walls = ground.walls
        low = np.array(walls.origin)
        high = low + np.array(walls.cells.shape[::-1]) * walls.resolution
        self._floor = Plan(low - 0.2, high + 0.2, PLAN_PX)
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


def _lay_cells(plan: Plan, grid: OccupancyGrid, grid_in_world: np.ndarray) -> None:
    """Draw the map's cells; unknown ones have the floor's colour."""
    cells = np.full((*grid.cells.shape, 3), bgr(FLOOR), np.uint8)
    cells[(grid.cells >= FREE) & (grid.cells < OCCUPIED_FROM)] = bgr(CLEAR)
    cells[grid.cells >= OCCUPIED_FROM] = bgr(TEXT)
    # The middle of pixel (0, 0) of the cells lies half a cell inside the grid.
    corners = np.array([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0)])
    points = (corners + 0.5) * grid.resolution + grid.origin
    there = plan.to_px(transform_points(np.asarray(grid_in_world), points)) - 0.5
    turn = cv2.getAffineTransform(corners.astype(np.float32), there.astype(np.float32))
    plan.image = cv2.warpAffine(cells, turn, plan.image.shape[1::-1], flags=cv2.INTER_NEAREST,
                                borderValue=bgr(FLOOR))


def map_picture(ground: Ground, result: Result, title: str, subtitle: str) -> np.ndarray:
    """The picture (rows, 1400, 3), BGR."""
    walls = ground.walls
    low = np.array(walls.origin)
    high = low + np.array(walls.cells.shape[::-1]) * walls.resolution
    figure, axes = map_sheet(title, subtitle, low - 0.3, high + 0.3)
    axes.grid(False)
    if result.map is not None:
        _draw_cells(axes, result.map, result.map_in_world)
    x, y = _edges(walls)
    middle = walls.resolution / 2
    axes.contour(x[:-1] + middle, y[:-1] + middle, walls.cells == OCCUPIED, levels=[0.5],
                 colors=[TRUE_WALL], linewidths=1)
    axes.plot([], [], color=TRUE_WALL, label="true wall")
    for part, text, colour in PATHS:
        axes.plot(*result.paths.get(part, np.empty((0, 2))).T, color=colour, linewidth=2,
                  label=text)
    ways = result.navigation["goals"] if result.navigation else []
    for number, way in enumerate(ways, start=1):
        goal = np.array([way["x"], way["y"], np.radians(way["yaw_deg"])])
        ends = transform_points(goal, np.array([(0.0, 0.0), (0.4, 0.0)]))
        axes.plot(*ends.T, color=GOAL if way["reached"] else CAR, linewidth=2, marker="o",
                  markevery=[0], markersize=12, fillstyle="none")
        axes.annotate(str(number), ends[0], (10, 8), textcoords="offset points", color=TEXT)
    for colour, text in ((GOAL, "goal"), (CAR, "not reached")):
        axes.plot([], [], "o", color=colour, fillstyle="none", label=text)
    legend(axes)
    return pixels(figure)


def _draw_cells(axes: object, grid: OccupancyGrid, grid_in_world: np.ndarray) -> None:
    """Draw free and occupied cells, transformed into the world's frame."""
    from matplotlib.colors import ListedColormap

    shade = np.zeros(grid.cells.shape)
    shade[(grid.cells >= FREE) & (grid.cells < OCCUPIED_FROM)] = 1
    shade[grid.cells >= OCCUPIED_FROM] = 2
    corners = np.stack(np.meshgrid(*_edges(grid)), axis=-1)
    there = transform_points(np.asarray(grid_in_world), corners.reshape(-1, 2))
    axes.pcolormesh(*there.reshape(corners.shape).transpose(2, 0, 1), shade, vmin=0, vmax=2,
                    cmap=ListedColormap([FLOOR, CLEAR, TEXT]), rasterized=True)


def _edges(grid: OccupancyGrid) -> tuple[np.ndarray, np.ndarray]:
    """x and y of the cells' borders in the grid's frame, m."""
    rows, columns = grid.cells.shape
    return (grid.origin[0] + np.arange(columns + 1) * grid.resolution,
            grid.origin[1] + np.arange(rows + 1) * grid.resolution)
