"""run.mp4 of the drive: the camera image with the mask, beside the course."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from racecar_description.track.track_file import TrackFile

from evaluation.colours import CAR, lap_colour
from evaluation.lap import LapScorer
from evaluation.plan import course_plan
from evaluation.session.film import CameraFilm, side_by_side
from run_session.course import Course

PLAN_PX = 520
MASK_LOW, MASK_HIGH = (20, 43, 46), (90, 255, 255)  # HSV, the lessons' bounds for yellow
MASK_TINT = (80, 60, 240)


class CourseFilm(CameraFilm):
    """The video of one drive round a course."""

    def __init__(self, path: Path, course: Course, track_file: TrackFile, drive: LapScorer,
                 period: float):
        super().__init__(path, course.camera, period)
        self._band, self._drive = course.film_band, drive
        self._floor, self._drawn = course_plan(track_file, PLAN_PX), 0

    def page(self, view: np.ndarray, now: float) -> np.ndarray:
        drive = self._drive
        words = {
            16: f"simulated time {now:5.1f} s",
            270: f"lap {drive.present_lap}/{drive.wanted_laps}   {drive.total.distance:5.2f} m"
                 f"   beside the line {drive.lateral * 100:+5.1f} cm",
        }
        return side_by_side(mark_line(view, self._band), self._plan(), words, self._period)

    def _plan(self) -> np.ndarray:
        """The course with the path so far and the car."""
        samples = self._drive.samples[:]
        if len(samples) - self._drawn > 1:
            fresh = [(sample.x, sample.y) for sample in samples[self._drawn:]]
            self._floor.line(fresh, lap_colour(self._drive.lap_numbers[len(samples) - 1]), 2)
            self._drawn = len(samples) - 1
        plan = self._floor.copy()
        if samples:
            plan.arrow((samples[-1].x, samples[-1].y, samples[-1].yaw), 0.2, CAR)
        return plan.image


def mark_line(view: np.ndarray, band: float) -> np.ndarray:
    """Tint the pixels in the lessons' mask, and draw a red dot where lesson 05 finds the line.

    It looks in a band at this share of the height; `band` 0: return the image as it is.
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
