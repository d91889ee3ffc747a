"""Writes run.mp4 while the car drives: the camera's picture with the mask, beside the map."""

from __future__ import annotations

import time
from pathlib import Path

import cv2
import numpy as np
import rospy
from cv_bridge import CvBridge
from sensor_msgs.msg import Image

from evaluation.lap import LapScorer
from evaluation.picture import PAPER, TEXT, CourseMap, draw_line, lap_colour, write_text
from evaluation.session.course_file import Course
from evaluation.session.film import FILM_RATE_HZ, VIEW_PX, FilmFile, fit
from evaluation.track import TrackFile

LONGEST_GAP = 25  # pictures that a pause in the camera may add to the film
LONGEST_WAIT = 1.0  # s, wall, in which no picture is looked at
MAP_WIDTH_PX, BAR_PX = 520, 44
MASK_LOW, MASK_HIGH = (20, 43, 46), (90, 255, 255)  # HSV, the lessons' bounds for yellow
MASK_TINT = (80, 60, 240)


class Film(FilmFile):
    """Adds one camera picture in `period` (s, simulated) to the film; works in the camera's thread.

    The callback waits until the next picture is nearly due, so the rest of the 190 MB a simulated
    second that the camera sends is dropped by the publisher's queue and never copied here.
    """

    def __init__(self, path: Path, course: Course, track_file: TrackFile, drive: LapScorer,
                 period: float):
        super().__init__(path)
        self._camera, self._band = course.camera, course.film_band
        self._drive, self._period = drive, period
        self._map = CourseMap(track_file, MAP_WIDTH_PX)
        self._floor, self._drawn = self._map.empty(), 0
        self._last: tuple[int, float] | None = None  # the last picture's number and s, wall
        self._subscriber: rospy.Subscriber | None = None

    def start(self) -> None:
        """Begin to film."""
        # 1 MiB at a time: with the 16 MiB that a follower wants, a picture took twice the time.
        self._subscriber = rospy.Subscriber(
            self._camera, Image, self.take, queue_size=1, buff_size=2**20
        )

    def take(self, message: Image) -> None:
        """Add a camera picture if one is due, and wait until the next one nearly is."""
        began, now = time.monotonic(), message.header.stamp.to_sec()
        number = int(now / self._period + 1e-6)  # stamps are rounded
        last, last_began = self._last or (number - 1, began)
        if self._ended.is_set() or number == last:
            return
        self._last = number, began
        frame = fit(CvBridge().imgmsg_to_cv2(message))
        if message.encoding == "rgb8":
            frame = cv2.cvtColor(frame, cv2.COLOR_RGB2BGR)
        # The film keeps simulated time even where pictures are missing.
        self._add(self._page(frame, now), min(max(number - last, 1), LONGEST_GAP))
        pace = (began - last_began) / max(number - last, 1)  # s, wall, from one picture to the next
        due = began + 0.8 * pace
        self._ended.wait(min(max(0.0, due - time.monotonic()), LONGEST_WAIT))

    def _page(self, frame: np.ndarray, now: float) -> np.ndarray:
        """Camera view and map side by side under a bar of figures."""
        view, plan = mark_line(frame, self._band), self._plan()
        height = max(view.shape[0], plan.shape[0]) + BAR_PX
        page = np.full((height + height % 2, VIEW_PX[0] + MAP_WIDTH_PX, 3), PAPER, np.uint8)
        left = (VIEW_PX[0] - view.shape[1]) // 2
        page[BAR_PX : BAR_PX + view.shape[0], left : left + view.shape[1]] = view
        top = BAR_PX + (height - BAR_PX - plan.shape[0]) // 2
        page[top : top + plan.shape[0], VIEW_PX[0] :] = plan
        drive = self._drive
        lap = min(len(drive.laps) + 1, drive.wanted_laps)
        write_text(page, f"simulated time {now:5.1f} s", (16, 29), 14, TEXT)
        figures = f"lap {lap}/{drive.wanted_laps}   {drive.total.distance:5.2f} m"
        write_text(
            page, f"{figures}   beside the line {drive.lateral * 100:+5.1f} cm", (270, 29), 14
        )
        speed = f"film at {self._period * FILM_RATE_HZ:g}x"
        write_text(page, speed, (page.shape[1] - 110, 29), 12)
        return page

    def _plan(self) -> np.ndarray:
        """The map with the path so far and the car."""
        samples = self._drive.samples[:]
        if len(samples) - self._drawn > 1:
            fresh = self._map.to_px([(sample.x, sample.y) for sample in samples[self._drawn :]])
            draw_line(self._floor, fresh, lap_colour(self._drive.lap_numbers[len(samples) - 1]), 2)
            self._drawn = len(samples) - 1
        plan = self._floor.copy()
        if samples:
            self._map.draw_car(plan, samples[-1].x, samples[-1].y, samples[-1].yaw)
        return plan


def mark_line(view: np.ndarray, band: float) -> np.ndarray:
    """Tint what the lessons' mask keeps, and put their red dot where lesson 05 finds the line.

    That is in a band at this share of the height; 0: the picture as it is.
    """
    if not band:
        return view
    mask = cv2.inRange(cv2.cvtColor(view, cv2.COLOR_BGR2HSV), MASK_LOW, MASK_HIGH)
    marked, line = view.copy(), mask > 0
    marked[line] = 0.35 * view[line] + 0.65 * np.array(MASK_TINT)
    height = view.shape[0]
    top, deep = round(band * height), max(1, round(20 * height / 1080))
    cv2.rectangle(marked, (0, top), (view.shape[1] - 1, top + deep), (120, 120, 120), 1)
    moments = cv2.moments(mask[top : top + deep], binaryImage=True)
    if moments["m00"] > 0:
        centre = round(moments["m10"] / moments["m00"]), top + deep // 2
        cv2.circle(marked, centre, 9, (0, 0, 255), -1, cv2.LINE_AA)
        cv2.circle(marked, centre, 9, (255, 255, 255), 1, cv2.LINE_AA)
    return marked
