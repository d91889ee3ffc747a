"""run.mp4: what the tracker sees, beside the room from above."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rospy
from cv_bridge import CvBridge
from sensor_msgs.msg import Image

from evaluation.picture import FAINT, PAPER, write_text
from evaluation.session.film import (
    FAST_FILM_PERIOD,
    FILM_PERIOD,
    FILM_RATE_HZ,
    VIEW_PX,
    FilmFile,
    fit,
)
from evaluation.tracking.room import Room
from evaluation.tracking.scene import Scene
from evaluation.tracking.score import TrackScorer

ROOM_PX, BAR_PX, GAP_PX = 480, 44, 8


class Film(FilmFile):
    """Adds one of the tracker's pictures in a period of simulated time."""

    def __init__(self, path: Path, topic: str, scene: Scene, drive: TrackScorer, fast: bool):
        super().__init__(path)
        self._topic, self._drive = topic, drive
        self._period = FAST_FILM_PERIOD / 2 if fast else FILM_PERIOD  # s, simulated
        self._room = Room(scene, ROOM_PX)
        self._number = -1

    def start(self) -> None:
        """Begin to film."""
        rospy.Subscriber(self._topic, Image, self.take, queue_size=1, buff_size=2**20)

    def take(self, message: Image) -> None:
        """Add a picture if one is due."""
        now = message.header.stamp.to_sec()
        number = int(now / self._period + 1e-6)
        if self._ended.is_set() or number == self._number or not self._drive.samples:
            return
        self._number = number
        self._add(self._page(CvBridge().imgmsg_to_cv2(message, "bgr8"), now))

    def _page(self, picture: np.ndarray, now: float) -> np.ndarray:
        """The two side by side under a bar of figures."""
        view, drive = fit(picture), self._drive
        height = max(ROOM_PX, VIEW_PX[1]) + BAR_PX + GAP_PX
        page = np.full((height, VIEW_PX[0] + ROOM_PX + 2 * GAP_PX, 3), PAPER, np.uint8)
        left = (VIEW_PX[0] - view.shape[1]) // 2
        top = BAR_PX + (ROOM_PX - view.shape[0]) // 2
        page[top:top + view.shape[0], left:left + view.shape[1]] = view
        plan = self._room.draw(drive.samples[:], drive.errors[:], drive.task)
        page[BAR_PX:BAR_PX + ROOM_PX, VIEW_PX[0] + GAP_PX:VIEW_PX[0] + GAP_PX + ROOM_PX] = plan
        write_text(page, f"simulated time {now:5.1f} s", (16, 29), 14)
        error = drive.errors[-1]
        text = (f"{error:5.2f} m to go" if drive.task.wanted is None
                else f"beside {drive.task.wanted:g} m: {error * 100:+5.1f} cm")
        write_text(page, f"{drive.distance:5.2f} m driven   {text}", (270, 29), 14)
        speed = f"film at {self._period * FILM_RATE_HZ:g}x"
        write_text(page, speed, (page.shape[1] - 110, 29), 12, FAINT)
        return page
