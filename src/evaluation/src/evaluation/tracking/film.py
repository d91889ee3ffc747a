"""run.mp4: what the tracker sees, beside the room from above."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
from ai_robot_tracking.scenes.scene import HALF_ROOM, SHADE_RADIUS, Scene
from ai_robot_tracking.scenes.world_file import RADIUS

from evaluation.colours import BAD, CAR, GOOD, HIDDEN
from evaluation.plan import Plan
from evaluation.session.film import CameraFilm, side_by_side
from evaluation.tracking.picture import (
    FOLLOWER,
    MARGIN,
    SHADE,
    TARGET_WAY,
    WALL,
    WALLS,
    target_way,
)
from evaluation.tracking.score import BAND, TrackScorer

PLAN_PX = 480


class TrackFilm(CameraFilm):
    """Of one drive after the cylinder."""

    def __init__(self, path: Path, topic: str, scene: Scene, drive: TrackScorer, period: float):
        super().__init__(path, topic, period)
        self._drive = drive
        edge = HALF_ROOM + MARGIN
        self._floor = Plan((-edge, -edge), (edge, edge), PLAN_PX)
        self._floor.grid(1.0)
        self._floor.line(WALLS, WALL, 4)
        for shade in scene.shades:
            self._floor.disc(shade, SHADE_RADIUS, SHADE)
        for thing in scene.lookalikes:
            red, green, blue = (round(255 * part) for part in thing.colour)
            self._floor.disc(thing.place[:2], 0.25, f"#{red:02x}{green:02x}{blue:02x}")

    def page(self, view: np.ndarray, now: float) -> np.ndarray:
        drive = self._drive
        if not drive.samples:
            return side_by_side(view, self._floor.image, {}, self._period)
        error = drive.errors[-1]
        text = (f"{error:5.2f} m to go" if drive.task.wanted is None
                else f"beside {drive.task.wanted:g} m: {error * 100:+5.1f} cm")
        words = {16: f"simulated time {now:5.1f} s",
                 270: f"{drive.distance:5.2f} m driven   {text}"}
        return side_by_side(view, self._plan(), words, self._period)

    def _plan(self) -> np.ndarray:
        """The drive so far: green where the distance was kept, else orange."""
        plan, drive = self._floor.copy(), self._drive
        samples, errors = drive.samples[:], drive.errors[:]
        now = samples[-1].time
        plan.line(target_way(drive.task, samples), TARGET_WAY, 2)
        near = np.abs(errors) <= BAND
        borders = [0, *(np.flatnonzero(np.diff(near)) + 1), len(near)]
        for begin, end in itertools.pairwise(borders):
            part = samples[max(begin - 1, 0):end]
            plan.line([(each.x, each.y) for each in part], GOOD if near[begin] else BAD, 2)
        hidden = any(begin <= now < begin + 3 for begin in drive.task.hidden)
        plan.disc(drive.task.target(now), RADIUS, HIDDEN if hidden else CAR)
        plan.arrow((samples[-1].x, samples[-1].y, samples[-1].yaw), 0.4, FOLLOWER)
        return plan.image
