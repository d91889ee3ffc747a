"""Pictures of a tracking drive: run.mp4 with a top view, path.png also with the distance."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from ai_robot_tracking.scenes.scene import HALF_ROOM, HIDDEN_TIME, SHADE_RADIUS, Scene
from ai_robot_tracking.scenes.world_file import RADIUS

from evaluation.colours import BAD, CAR, FAINT, GOOD, HIDDEN
from evaluation.lap import Sample
from evaluation.picture import below, draw_arrow, legend, map_sheet, pixels, write_png
from evaluation.plan import Plan
from evaluation.session.film import CameraFilm, side_by_side
from evaluation.tracking.score import BAND, Task, TrackScorer

TARGET_WAY, SHADE, FOLLOWER, WALL = "#823c46", "#24262a", "#78c8f0", "#8c9196"
MARGIN = 0.15  # m round the walls
WALLS = HALF_ROOM * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)])
CURVE = 3.0  # inches
MOST_SHOWN = 1.0  # m off the wanted distance, at the plot's edges
PLAN_PX = 480


class TrackFilm(CameraFilm):
    """The video of one tracking drive."""

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
        """Top view of the drive so far: green where the distance was kept, else orange."""
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


def target_way(task: Task, samples: Sequence[Sample]) -> list[np.ndarray]:
    """The cylinder's positions during the samples, each (x, y), m."""
    times = np.arange(samples[0].time, samples[-1].time, 0.2)
    return [task.target(time) for time in times] or [task.target(samples[-1].time)]


def write_picture(path: Path, scene: Scene, drive: TrackScorer, lines: Sequence[str]) -> None:
    """Write path.png; its title and figures are the summary's lines."""
    edge = HALF_ROOM + MARGIN
    figure, axes = map_sheet(lines[0], "   |   ".join(lines[1:3]), (-edge, -edge), (edge, edge),
                             CURVE)
    axes.plot(*WALLS.T, color=WALL, linewidth=4)
    for place in scene.shades:
        _disc(axes, place, SHADE_RADIUS, SHADE)
    for thing in scene.lookalikes:
        _disc(axes, thing.place[:2], 0.25, thing.colour)
    task, last = drive.task, drive.samples[-1]
    axes.plot(*np.transpose(target_way(task, drive.samples)), color=TARGET_WAY, linewidth=2)
    _disc(axes, task.target(last.time), RADIUS, CAR, label="the cylinder")
    _draw_runs(axes, *np.transpose([(each.x, each.y) for each in drive.samples]), drive)
    draw_arrow(axes, (last.x, last.y, last.yaw), 0.4, FOLLOWER)
    legend(axes)
    _draw_curve(below(figure, CURVE), drive)
    write_png(path, pixels(figure))


def _draw_runs(axes: object, x: np.ndarray, y: np.ndarray, drive: TrackScorer) -> None:
    """Plot a curve: green where the distance was kept, else orange."""
    near = np.abs(drive.errors) <= BAND
    what = "cylinder" if drive.task.wanted is None else "wanted distance"
    for chosen, colour, text in ((near, GOOD, f"within {BAND:g} m of the {what}"),
                                 (~near, BAD, "not")):
        axes.plot(x, np.where(chosen, y, np.nan), color=colour, linewidth=2, label=text)


def _draw_curve(axes: object, drive: TrackScorer) -> None:
    """Plot the deviation from the wanted distance (or the distance to the cylinder), m, over s."""
    times = np.array([each.time for each in drive.samples]) - drive.samples[0].time
    wanted = drive.task.wanted is not None
    low, high = (-MOST_SHOWN, MOST_SHOWN) if wanted else (0.0, max(*drive.errors, 0.1))
    for mark in (-BAND, 0.0, BAND) if wanted else (0.0,):
        axes.axhline(mark, color=FAINT, linewidth=1)
    for begin in drive.task.hidden:
        since = begin - drive.samples[0].time
        axes.axvspan(since, since + HIDDEN_TIME, color=HIDDEN, alpha=0.3)
    _draw_runs(axes, times, np.clip(drive.errors, low, high), drive)
    axes.set(xlim=(0, max(times[-1], 0.1)), ylim=(low, high), xlabel="s")
    axes.set_title("m beside the wanted distance" if wanted else "m to the cylinder", loc="left",
                   fontsize=9, color=FAINT)


def _disc(axes: object, place: Sequence[float], radius: float, colour: object,
          label: str | None = None) -> None:
    turn = np.linspace(0, 2 * np.pi, 48)
    axes.fill(place[0] + radius * np.cos(turn), place[1] + radius * np.sin(turn), color=colour,
              label=label)
