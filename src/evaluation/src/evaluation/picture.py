"""Pictures by matplotlib, which is loaded only when one is drawn, so that no drive waits for it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import TrackFile

from evaluation import colours
from evaluation.colours import LAPS, PAPER, TEXT, lap_colour
from evaluation.lap import LapScorer
from evaluation.plan import arrow, start_mark
from run_session.files import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DPI, WIDTH, SIDE, HEADER, FOOT = 100, 14.0, 0.5, 1.25, 0.45  # px an inch; inches
PANEL_DPI, PANEL = 110, (6.5, 3.4)  # of charts: px an inch; inches


def map_sheet(title: str, subtitle: str, low: Sequence[float], high: Sequence[float],
              more: float = 0.0) -> tuple[Figure, Axes]:
    """A figure, 1400 px wide, with a map of the area between two corners (x, y), m.

    `more` inches stay free below the map.
    """
    from matplotlib.figure import Figure

    (left, bottom), (right, top) = low, high
    map_width = WIDTH - 2 * SIDE
    map_height = map_width * (top - bottom) / (right - left)
    height = HEADER + map_height + FOOT + more
    figure = Figure(figsize=(WIDTH, height), dpi=DPI, facecolor=PAPER)
    figure.text(SIDE / WIDTH, 1 - 0.62 / height, title, color=TEXT, size=22)
    figure.text(SIDE / WIDTH, 1 - 1.02 / height, subtitle, color=colours.FAINT, size=11)
    axes = figure.add_axes((SIDE / WIDTH, (FOOT + more) / height, map_width / WIDTH,
                            map_height / height))
    axes.set(xlim=(left, right), ylim=(bottom, top), xlabel="m")
    _finish(axes)
    return figure, axes


def below(figure: Figure, more: float) -> Axes:
    """Axes for a curve in the `more` inches below a map."""
    height = figure.get_figheight()
    axes = figure.add_axes(
        (SIDE / WIDTH, 0.6 / height, 1 - 2 * SIDE / WIDTH, (more - 0.7) / height))
    _finish(axes)
    return axes


def legend(axes: Axes) -> None:
    """Add a legend where it covers least."""
    axes.legend(facecolor=PAPER, edgecolor=colours.GRID, labelcolor=TEXT, fontsize=9)


def draw_arrow(axes: Axes, pose: Sequence[float], length: float, colour: str) -> None:
    """Draw an arrow head of this length (m) at x, y, yaw; m, rad."""
    axes.fill(*arrow(pose, length).T, facecolor=colour, edgecolor="white", zorder=5)


def pixels(figure: Figure) -> np.ndarray:
    """The figure as a picture (rows, columns, 3), BGR."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., 2::-1].copy()


def write_png(path: Path, picture: np.ndarray) -> None:
    """Write (rows, columns, 3), BGR, as PNG; OSError, and no file, if it cannot be written."""
    write_whole(path, cv2.imencode(".png", picture)[1].tobytes())


def path_picture(track_file: TrackFile, drive: LapScorer, title: str, subtitle: str) -> np.ndarray:
    """The driven path over the course (rows, 1400, 3), BGR, a colour for each lap."""
    yellow = build_track(track_file)
    white = yellow.offset(-track_file.lane_width)
    lines = [np.array([*line.points(), line.points()[0]]) for line in (yellow, white)]
    everything = np.concatenate(lines)
    figure, axes = map_sheet(title, subtitle, everything.min(0) - 0.15, everything.max(0) + 0.15)
    points_a_metre = 72 * (WIDTH - 2 * SIDE) / (np.ptp(everything[:, 0]) + 0.3)
    texts = ("yellow: what the car follows", "white: right edge of the lane")
    for points, colour, text in zip(lines, (colours.LINE, colours.WHITE), texts, strict=True):
        axes.plot(*points.T, color=colour, label=text,
                  linewidth=max(1.5, track_file.line_width * points_a_metre))
    axes.plot(*start_mark(yellow.pose(0.0)).T, color=TEXT, linewidth=2)
    _draw_laps(axes, drive)
    legend(axes)
    return pixels(figure)


def _draw_laps(axes: Axes, drive: LapScorer) -> None:
    """Draw all laps; they overlap, so earlier ones are wider, to remain visible."""
    if not drive.samples:
        return
    points = np.array([(sample.x, sample.y) for sample in drive.samples])
    numbers = np.minimum(drive.lap_numbers, drive.wanted_laps - 1)
    for number in range(numbers[-1] + 1):
        chosen = np.flatnonzero(numbers == number)
        text = f"lap {number + 1}{_lap_figures(drive, number)}" if number < len(LAPS) else None
        axes.plot(*points[max(chosen[0] - 1, 0):chosen[-1] + 1].T, color=lap_colour(number),
                  label=text, linewidth=2 * (1 + 0.6 * min(numbers[-1] - number, 4)))
    if numbers[-1] >= len(LAPS):
        axes.plot([], [], color=colours.FAINT,
                  label=f"laps {len(LAPS) + 1} to {numbers[-1] + 1}: the same colours again")
    last = drive.samples[-1]
    draw_arrow(axes, (last.x, last.y, last.yaw), 0.2, colours.CAR)


def _lap_figures(drive: LapScorer, number: int) -> str:
    if number >= len(drive.laps):
        return ", not closed"
    lap = drive.laps[number]
    return f": {lap.time:.1f} s, {lap.distance:.2f} m, RMS {lap.rms_lateral * 100:.1f} cm"


def write_tiles(path: Path, tiles: Sequence[Any], draw: Callable[[Axes, Any], tuple[str, bool]],
                size: tuple[float, float], columns: int = 5) -> None:
    """Write a picture of one small plot for each tile, `size` in inches (width, height).

    `draw` draws one and returns its caption, and whether it was a success.
    """
    from matplotlib.figure import Figure

    columns, rows = min(columns, len(tiles)), -(-len(tiles) // columns)
    figure = Figure(figsize=(size[0] * columns, size[1] * rows), dpi=DPI, facecolor=PAPER,
                    layout="constrained")
    for number, tile in enumerate(tiles, start=1):
        axes = figure.add_subplot(rows, columns, number, facecolor=colours.FLOOR)
        axes.set(xticks=(), yticks=(), aspect="equal")
        caption, good = draw(axes, tile)
        axes.set_title(caption, fontsize=7, color=TEXT if good else colours.CAR)
    write_png(path, pixels(figure))


@contextlib.contextmanager
def chart(path: Path, rows: int, columns: int, **settings: object) -> Iterator[np.ndarray]:
    """A context that yields the Axes (rows, columns) of a chart and writes it at the end."""
    from matplotlib.figure import Figure

    sheet = Figure(figsize=(PANEL[0] * columns, PANEL[1] * rows), dpi=PANEL_DPI)
    grid = sheet.subplots(rows, columns, squeeze=False, **settings)
    yield grid
    for axes in grid.flat:
        axes.tick_params(labelsize=8, length=0)
        axes.grid(alpha=0.3)
    sheet.tight_layout()
    write_png(path, pixels(sheet))


def _finish(axes: Axes) -> None:
    axes.set_facecolor(colours.FLOOR)
    axes.grid(color=colours.GRID)
    axes.tick_params(colors=colours.FAINT, labelsize=8, length=0)
    axes.xaxis.label.set_color(colours.FAINT)
    axes.yaxis.label.set_color(colours.FAINT)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_visible(False)
