"""Colours, top views in pixels, and pictures by matplotlib, which is loaded only to draw one."""

from __future__ import annotations

import contextlib
import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import TrackFile

from evaluation.lap import LapScorer
from run_session.files import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PAPER, FLOOR, GRID, TEXT, FAINT = "#181a1e", "#0e0e10", "#24272c", "#e4e8eb", "#989ea5"
LINE, WHITE = "#ffff00", "#e1e1e1"  # lines of AutoRace's courses, as cameras see them
LAPS = ("#46aaf0", "#fa6e6e", "#5ad282", "#d278dc", "#fabe5a", "#50c8c8")
CAR, GOOD, BAD, HIDDEN = "#f03c3c", "#5ad282", "#faaa3c", "#6e8296"
START = "#ff8c00"


def lap_colour(number: int) -> str:
    """The colour of a lap, counted from 0."""
    return LAPS[number % len(LAPS)]


def bgr(colour: str) -> tuple[int, int, int]:
    """Blue, green, red from 0 to 255, as OpenCV has them."""
    return tuple(bytes.fromhex(colour[1:])[::-1])


FONT = cv2.FONT_HERSHEY_DUPLEX
SHIFT = 4  # cv2 draws between pixels when coordinates are given in sixteenths
HEAD = np.array([(0.6, 0.0), (-0.4, 0.375), (-0.2, 0.0), (-0.4, -0.375)])  # of an arrow of length 1


class Plan:
    """A view of the area between two corners (x, y), m, scaled to a width; y points up."""

    def __init__(self, low: Sequence[float], high: Sequence[float], width_px: int):
        self._low, self._high = np.asarray(low, float), np.asarray(high, float)
        self.px_per_m = width_px / (self._high[0] - self._low[0])
        height_px = round((self._high[1] - self._low[1]) * self.px_per_m)
        self.image = np.full((height_px, width_px, 3), bgr(FLOOR), np.uint8)

    def copy(self) -> Plan:
        """A copy that can be drawn on further."""
        other = Plan(self._low, self._high, self.image.shape[1])
        other.image = self.image.copy()
        return other

    def to_px(self, points: Iterable[Sequence[float]]) -> np.ndarray:
        """World points (n, 2) as pixel coordinates (n, 2), float."""
        points = np.asarray(points, float).reshape(-1, 2)
        return (points - (self._low[0], self._high[1])) * (self.px_per_m, -self.px_per_m)

    def grid(self, step: float) -> None:
        """Draw grid lines `step` metres apart."""
        for axis in (0, 1):
            first, last = math.ceil(self._low[axis] / step), math.floor(self._high[axis] / step)
            for number in range(first, last + 1):
                ends = np.array((self._low, self._high))
                ends[:, axis] = number * step
                self.line(ends, GRID)

    def line(self, points: Iterable[Sequence[float]], colour: str, thick_px: int = 1,
             closed: bool = False) -> None:
        """Draw a line through points (n, 2) of the world, m, anti-aliased."""
        pixels = _fixed(self.to_px(points))
        if len(pixels) > 1:
            cv2.polylines(self.image, [pixels], closed, bgr(colour), thick_px, cv2.LINE_AA, SHIFT)

    def disc(self, place: Sequence[float], radius: float, colour: str) -> None:
        """Draw a disc; place and radius in m."""
        centre = _fixed(self.to_px([place]))[0].tolist()
        cv2.circle(self.image, centre, round(radius * self.px_per_m * (1 << SHIFT)), bgr(colour),
                   -1, cv2.LINE_AA, SHIFT)

    def dots(self, points: np.ndarray, colour: str) -> None:
        """Draw dots, 3 px wide, at points (n, 2), m."""
        for x, y in np.round(self.to_px(points)).astype(int).tolist():
            cv2.rectangle(self.image, (x - 1, y - 1), (x + 1, y + 1), bgr(colour), -1)

    def arrow(self, pose: Sequence[float], length: float, colour: str) -> None:
        """Draw an arrow head (length in m) with its reference point at x, y, yaw."""
        corners = _fixed(self.to_px(arrow(pose, length)))
        cv2.fillPoly(self.image, [corners], bgr(colour), cv2.LINE_AA, SHIFT)
        cv2.polylines(self.image, [corners], True, (255, 255, 255), 2, cv2.LINE_AA, SHIFT)


def course_plan(track_file: TrackFile, width_px: int, line_colour: str,
                margin: float = 0.15) -> Plan:
    """A view of the floor with a 0.5 m grid, the two lines and the start."""
    yellow = build_track(track_file)
    white = yellow.offset(-track_file.lane_width)
    points = np.array(yellow.points() + white.points())
    plan = Plan(points.min(axis=0) - margin, points.max(axis=0) + margin, width_px)
    plan.grid(0.5)
    for line, colour in ((white, WHITE), (yellow, line_colour)):
        plan.line(line.points(), colour, max(2, round(track_file.line_width * plan.px_per_m)),
                  closed=True)
    plan.line(start_mark(yellow.pose(0.0)), START, 3)
    return plan


def start_mark(pose: Sequence[float]) -> np.ndarray:
    """Ends (2, 2) of a short line across the track's start."""
    x, y, heading = pose
    across = 0.07 * np.array((math.sin(heading), -math.cos(heading)))
    return np.array((x, y)) + np.array((-across, across))


def arrow(pose: Sequence[float], length: float) -> np.ndarray:
    """Corners (4, 2) of an arrow head with its reference point at x, y, yaw; m, rad."""
    x, y, yaw = pose
    turn = np.array([(math.cos(yaw), math.sin(yaw)), (-math.sin(yaw), math.cos(yaw))])
    return length * HEAD @ turn + (x, y)


def write_text(image: np.ndarray, text: str, at_px: tuple[int, int], height_px: int,
               colour: tuple = bgr(TEXT)) -> int:
    """Draw text with its baseline's left end at a pixel; returns its width in px."""
    thick = 2 if height_px > 24 else 1
    scale = cv2.getFontScaleFromHeight(FONT, height_px, thick)
    cv2.putText(image, text, at_px, FONT, scale, colour, thick, cv2.LINE_AA)
    return cv2.getTextSize(text, FONT, scale, thick)[0][0]


LEGEND_PX = 28  # height of a legend's bar


def legend_bar(width_px: int, entries: Iterable[tuple[str, str]]) -> np.ndarray:
    """A bar (LEGEND_PX, width, 3), BGR, that says in words what colours mean."""
    bar = np.full((LEGEND_PX, width_px, 3), bgr(PAPER), np.uint8)
    left, middle = 16, LEGEND_PX // 2
    for text, colour in entries:
        cv2.rectangle(bar, (left, middle - 3), (left + 18, middle + 3), bgr(colour), -1)
        left += 46 + write_text(bar, text, (left + 25, middle + 5), 11)
    return bar


def _fixed(points_px: np.ndarray) -> np.ndarray:
    return np.round(np.asarray(points_px) * (1 << SHIFT)).astype(np.int32)


DPI, WIDTH, SIDE, HEADER, FOOT = 100, 14.0, 0.5, 1.25, 0.45  # px an inch; inches
ARROW = 0.055  # the length of the car's arrow for one of the course's width
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
    figure.text(SIDE / WIDTH, 1 - 1.02 / height, subtitle, color=FAINT, size=11)
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
    """Add a legend where it covers least; matplotlib warns if that takes a second."""
    warnings.filterwarnings("ignore", "Creating legend with loc")
    axes.legend(facecolor=PAPER, edgecolor=GRID, labelcolor=TEXT, fontsize=9)


def draw_arrow(axes: Axes, pose: Sequence[float], length: float, colour: str,
               text: str | None = None) -> None:
    """Draw an arrow head of this length (m) at x, y, yaw; m, rad; `text` goes into the legend."""
    axes.fill(*arrow(pose, length).T, facecolor=colour, edgecolor="white", zorder=5, label=text)


def pixels(figure: Figure) -> np.ndarray:
    """The figure as a picture (rows, columns, 3), BGR."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., 2::-1].copy()


def write_png(path: Path, picture: np.ndarray) -> None:
    """Write (rows, columns, 3), BGR, as PNG; OSError, and no file, if it cannot be written."""
    write_whole(path, cv2.imencode(".png", picture)[1].tobytes())


def path_picture(track_file: TrackFile, drive: LapScorer, line_colour: str, title: str,
                 subtitle: str) -> np.ndarray:
    """The driven path over the course (rows, 1400, 3), BGR, a colour for each lap."""
    yellow = build_track(track_file)
    white = yellow.offset(-track_file.lane_width)
    lines = [np.array([*line.points(), line.points()[0]]) for line in (yellow, white)]
    everything = np.concatenate(lines)
    figure, axes = map_sheet(title, subtitle, everything.min(0) - 0.15, everything.max(0) + 0.15)
    points_a_metre = 72 * (WIDTH - 2 * SIDE) / (np.ptp(everything[:, 0]) + 0.3)
    texts = ("the line that the car follows", "right edge of the lane")
    for points, colour, text in zip(lines, (line_colour, WHITE), texts, strict=True):
        axes.plot(*points.T, color=colour, label=text,
                  linewidth=max(1.5, track_file.line_width * points_a_metre))
    axes.plot(*start_mark(yellow.pose(0.0)).T, color=START, linewidth=3, label="start")
    _draw_laps(axes, drive, ARROW * np.ptp(everything[:, 0]))
    legend(axes)
    return pixels(figure)


def _draw_laps(axes: Axes, drive: LapScorer, arrow_length: float) -> None:
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
        axes.plot([], [], color=FAINT,
                  label=f"laps {len(LAPS) + 1} to {numbers[-1] + 1}: the same colours again")
    last = drive.samples[-1]
    draw_arrow(axes, (last.x, last.y, last.yaw), arrow_length, CAR, "car at the end")


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
        axes = figure.add_subplot(rows, columns, number, facecolor=FLOOR)
        axes.set(xticks=(), yticks=(), aspect="equal")
        caption, good = draw(axes, tile)
        axes.set_title(caption, fontsize=7, color=TEXT if good else CAR)
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
    axes.set_facecolor(FLOOR)
    axes.grid(color=GRID)
    axes.tick_params(colors=FAINT, labelsize=8, length=0)
    axes.xaxis.label.set_color(FAINT)
    axes.yaxis.label.set_color(FAINT)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_visible(False)
