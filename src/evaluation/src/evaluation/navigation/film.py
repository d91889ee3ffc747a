"""run.mp4: the camera's picture beside the map, with the scan, the plan and the way driven."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import rospy
from cv_bridge import CvBridge
from sensor_msgs.msg import Image

from evaluation.house.ground import Ground
from evaluation.house.house_map import HouseMap
from evaluation.house.records import Records
from evaluation.house.watch import Watch
from evaluation.navigation.score import Result
from evaluation.picture import FAINT, LAP_COLOURS, PAPER, write_text
from evaluation.session.film import FILM_RATE_HZ, VIEW_PX, FilmFile, fit
from nav_algorithms.poses import compose, transform_points

CAMERA = "/camera/rgb/image_raw"
LASER = np.array([-0.064, 0.0, 0.0])  # in base_footprint
PERIOD = 1.0  # s, simulated, between two pictures: the film runs at ten times the speed
LOOK_PERIOD = 0.1  # s, wall
MAP_WIDTH_PX, BAR_PX, SIDE_PX = 760, 48, 12
SCAN, PLAN, DRIVEN = (80, 80, 255), (90, 230, 250), LAP_COLOURS[0]  # BGR


class Film(FilmFile):
    """Adds a picture in PERIOD (s, simulated) while a part of the run goes on."""

    def __init__(self, path: Path, ground: Ground, watch: Watch, result: Result):
        super().__init__(path)
        self._watch, self._result = watch, result
        walls = ground.walls
        low = np.array(walls.origin)
        high = low + np.array(walls.cells.shape[::-1]) * walls.resolution
        self._house = HouseMap(low - 0.2, high + 0.2, MAP_WIDTH_PX)
        self._view: Image | None = None
        self._eye: rospy.Subscriber | None = None
        self._title = ""
        self._records: Records | None = None
        self._number = -1
        self._thread = threading.Thread(target=self._film, daemon=True, name="film")

    def start(self) -> None:
        """Begin to film."""
        self._thread.start()

    def tell(self, title: str) -> None:
        """What is going on now."""
        self._title = title

    def close(self) -> None:
        """Finish the file, if there is any picture."""
        self.stop()
        if self._thread.ident is not None:
            self._thread.join()
        super().close()

    def _look(self) -> None:
        """Ask for one picture: while somebody subscribes, the camera draws thirty a second."""
        if self._eye is None:
            self._eye = rospy.Subscriber(CAMERA, Image, self._take, queue_size=1, buff_size=2**20)

    def _take(self, message: Image) -> None:
        self._view, eye, self._eye = message, self._eye, None
        if eye is not None:
            eye.unregister()

    def _film(self) -> None:
        while not self._ended.wait(LOOK_PERIOD):
            records = self._watch.records
            if records is not self._records:
                self._records, self._number = records, -1
            number = int(records.now / PERIOD)
            if records.truth and number > self._number:
                self._number = number
                self._add(self._page(records))
                self._look()

    def _page(self, records: Records) -> np.ndarray:
        """Camera view and map side by side under a bar of text."""
        plan = self._plan(records)
        height = max(plan.shape[0], VIEW_PX[1]) + BAR_PX + SIDE_PX
        width = VIEW_PX[0] + MAP_WIDTH_PX + 3 * SIDE_PX
        page = np.full((height + height % 2, width + width % 2, 3), PAPER, np.uint8)
        left = VIEW_PX[0] + 2 * SIDE_PX
        page[BAR_PX:BAR_PX + plan.shape[0], left:left + plan.shape[1]] = plan
        if self._view is not None:
            view = fit(CvBridge().imgmsg_to_cv2(self._view, "bgr8"))
            page[BAR_PX:BAR_PX + view.shape[0], SIDE_PX:SIDE_PX + view.shape[1]] = view
        write_text(page, self._title, (SIDE_PX, 31), 15)
        touched = len(records.contacts)
        figures = f"{records.now:6.1f} s   {records.length:6.1f} m   touched {touched}"
        write_text(page, figures, (left, 31), 14)
        speed = f"film at {PERIOD * FILM_RATE_HZ:g}x"
        write_text(page, speed, (page.shape[1] - 120, 31), 12, FAINT)
        return page

    def _plan(self, records: Records) -> np.ndarray:
        """The map as it is now, on it what the robot sees, wants and has done."""
        watch, house, there = self._watch, self._house, self._result.map_in_world
        plan = house.draw_cells(watch.map, there)
        house.draw_path(plan, np.array(records.truth).reshape(-1, 4)[:, 1:3], DRIVEN, 2)
        house.draw_path(plan, transform_points(there, watch.plan), PLAN, 2)
        if watch.scan is not None and records.believed:
            laser = compose(compose(there, records.believed_pose), LASER)
            house.draw_dots(plan, transform_points(laser, watch.scan.points), SCAN)
        house.draw_robot(plan, records.true_pose)
        return plan
