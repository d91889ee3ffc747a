"""The room from above, in pixels: the cylinder and its way, the car and its way."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import cv2
import numpy as np

from evaluation.lap import Sample
from evaluation.picture import FLOOR, GRID, SHIFT, draw_line
from evaluation.tracking.scene import HALF_ROOM, SHADE_RADIUS, Scene
from evaluation.tracking.score import BAND, Task
from evaluation.tracking.sdf import RADIUS

WALL, TARGET, TARGET_WAY = (150, 145, 140), (40, 40, 235), (70, 60, 130)  # BGR
SHADE = (42, 38, 36)
NEAR, FAR, HIDDEN = (130, 210, 90), (60, 170, 250), (150, 130, 110)
MARGIN = 0.15  # m round the walls


class Room:
    """Drawn square to fit a width; world coordinates in m, y up."""

    def __init__(self, scene: Scene, width_px: int):
        self.px_per_m = width_px / (2 * (HALF_ROOM + MARGIN))
        self._scene, self._width_px = scene, width_px
        self._floor = self._empty()

    def draw(self, samples: Sequence[Sample], errors: Sequence[float], task: Task) -> np.ndarray:
        """The drive so far (width, width, 3): green where the distance was kept, else orange."""
        image = self._floor.copy()
        if not samples:
            return image
        now = samples[-1].time
        thick = max(2, round(self._width_px / 300))
        way = [task.target(time) for time in np.arange(samples[0].time, now, 0.2)]
        draw_line(image, self._px(way or [task.target(now)]), TARGET_WAY, thick)
        ways = self._px([(each.x, each.y) for each in samples])
        near = np.abs(errors) <= BAND
        borders = [0, *(np.flatnonzero(np.diff(near)) + 1), len(near)]
        for begin, end in itertools.pairwise(borders):
            draw_line(image, ways[max(begin - 1, 0):end], NEAR if near[begin] else FAR, thick)
        hidden = any(begin <= now < begin + 3 for begin in task.hidden)
        self._disc(image, task.target(now), RADIUS, HIDDEN if hidden else TARGET)
        self._car(image, samples[-1])
        return image

    def _empty(self) -> np.ndarray:
        image = np.full((self._width_px, self._width_px, 3), FLOOR, np.uint8)
        for k in range(-math.floor(HALF_ROOM), math.floor(HALF_ROOM) + 1):
            for ends in (((k, -HALF_ROOM), (k, HALF_ROOM)), ((-HALF_ROOM, k), (HALF_ROOM, k))):
                draw_line(image, self._px(ends), GRID, 1)
        for shade in self._scene.shades:
            self._disc(image, shade, SHADE_RADIUS, SHADE)
        corners = [(-HALF_ROOM, -HALF_ROOM), (HALF_ROOM, -HALF_ROOM), (HALF_ROOM, HALF_ROOM),
                   (-HALF_ROOM, HALF_ROOM)]
        draw_line(image, self._px(corners), WALL, max(2, round(0.08 * self.px_per_m)), closed=True)
        for thing in self._scene.lookalikes:
            colour = tuple(round(255 * part) for part in reversed(thing.colour))
            self._disc(image, thing.place[:2], 0.25, colour)
        return image

    def _px(self, points: Sequence) -> np.ndarray:
        edge = HALF_ROOM + MARGIN
        return (np.asarray(points, float) - (-edge, edge)) * (self.px_per_m, -self.px_per_m)

    def _disc(
        self, image: np.ndarray, place: Sequence[float], radius: float, colour: tuple
    ) -> None:
        centre = np.round(self._px([place])[0] * (1 << SHIFT)).astype(int)
        size = round(radius * self.px_per_m * (1 << SHIFT))
        cv2.circle(image, tuple(centre.tolist()), size, colour, -1, cv2.LINE_AA, SHIFT)

    def _car(self, image: np.ndarray, sample: Sample) -> None:
        shape = np.array([(0.22, 0.0), (-0.18, 0.15), (-0.1, 0.0), (-0.18, -0.15)])
        c, s = math.cos(sample.yaw), math.sin(sample.yaw)
        corners = self._px(shape @ np.array([(c, s), (-s, c)]) + (sample.x, sample.y))
        fixed = np.round(corners * (1 << SHIFT)).astype(np.int32)
        cv2.fillPoly(image, [fixed], (240, 200, 120), cv2.LINE_AA, SHIFT)
        cv2.polylines(image, [fixed], True, (255, 255, 255), 1, cv2.LINE_AA, SHIFT)
