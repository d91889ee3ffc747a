"""Colours, top views in pixels, and charts by matplotlib, which is loaded only to draw one."""

from __future__ import annotations

import contextlib
import copy
import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import TrackFile

from evaluation.lap import LapScorer
from run_session.files import write_whole

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
NUMBER_PX, NUMERAL_PX = 35, 9  # room for the number of a grid's line, and its height
SHIFT = 4  # cv2 draws between pixels when coordinates are given in sixteenths
HEAD = np.array([(0.6, 0.0), (-0.4, 0.375), (-0.2, 0.0), (-0.4, -0.375)])  # of an arrow of length 1


class Plan:
    """A view of the area between two corners (x, y), m, scaled to a width; y points up."""

    def __init__(self, low: Sequence[float], high: Sequence[float], width_px: int,
                 height_px: int | None = None):
        """`height_px`: with another scale upwards, as a curve has."""
        self._low, self._high = np.asarray(low, float), np.asarray(high, float)
        wide, high_m = self._high - self._low
        self.px_per_m = width_px / wide
        height_px = height_px or round(high_m * self.px_per_m)
        self._scale = self.px_per_m, -height_px / high_m
        self.image = np.full((height_px, width_px, 3), bgr(FLOOR), np.uint8)

    def copy(self) -> Plan:
        """A copy that can be drawn on further."""
        other = copy.copy(self)
        other.image = self.image.copy()
        return other

    def to_px(self, points: Iterable[Sequence[float]]) -> np.ndarray:
        """World points (n, 2) as pixel coordinates (n, 2), float."""
        points = np.asarray(points, float).reshape(-1, 2)
        return (points - (self._low[0], self._high[1])) * self._scale

    def grid(self, step: float, step_up: float | None = None) -> None:
        """Draw lines `step` metres apart, with numbers at as many as there is room for."""
        for axis, apart in enumerate((step, step_up or step)):
            first, last = math.ceil(self._low[axis] / apart), math.floor(self._high[axis] / apart)
            numbered = math.ceil(NUMBER_PX / abs(apart * self._scale[axis]))
            for number in range(first, last + 1):
                ends = np.array((self._low, self._high))
                ends[:, axis] = number * apart
                self.line(ends, GRID)
                if number % numbered == 0:
                    self._number(f"{number * apart:g}", *self.to_px(ends)[0].round().astype(int))

    def _number(self, text: str, x: int, y: int) -> None:
        """Write it right of and above a line's end, px; left or below where the plan ends."""
        right, above = x + 4 + text_width(text, NUMERAL_PX), y - 4 - NUMERAL_PX
        left = x + 4 if right <= self.image.shape[1] else 2 * x - right
        base = y - 4 if above >= 0 else y + 4 + NUMERAL_PX
        write_text(self.image, text, (int(left), int(base)), NUMERAL_PX, bgr(FAINT))

    def line(self, points: Iterable[Sequence[float]], colour: str, thick_px: int = 1,
             closed: bool = False) -> None:
        """Draw a line through points (n, 2) of the world, m, anti-aliased."""
        pixels = _fixed(self.to_px(points))
        if len(pixels) > 1:
            cv2.polylines(self.image, [pixels], closed, bgr(colour), thick_px, cv2.LINE_AA, SHIFT)

    def disc(self, place: Sequence[float], radius: float, colour: str, thick_px: int = -1) -> None:
        """Draw a disc, or a ring that is so thick; place and radius in m."""
        centre = _fixed(self.to_px([place]))[0].tolist()
        cv2.circle(self.image, centre, round(radius * self.px_per_m * (1 << SHIFT)), bgr(colour),
                   thick_px, cv2.LINE_AA, SHIFT)

    def box(self, low: Sequence[float], high: Sequence[float], colour: str) -> None:
        """Fill the rectangle between two corners (x, y), m."""
        one, other = np.round(self.to_px([low, high])).astype(int).tolist()
        cv2.rectangle(self.image, one, other, bgr(colour), -1)

    def cross(self, place: Sequence[float], colour: str) -> None:
        """Draw a cross, 14 px wide."""
        cv2.drawMarker(self.image, tuple(np.round(self.to_px([place]))[0].astype(int).tolist()),
                       bgr(colour), cv2.MARKER_TILTED_CROSS, 14, 2, cv2.LINE_AA)

    def dots(self, points: np.ndarray, colour: str) -> None:
        """Draw dots, 3 px wide, at points (n, 2), m."""
        for x, y in np.round(self.to_px(points)).astype(int).tolist():
            cv2.rectangle(self.image, (x - 1, y - 1), (x + 1, y + 1), bgr(colour), -1)

    def arrow(self, pose: Sequence[float], length: float, colour: str) -> None:
        """Draw an arrow head (length in m) with its reference point at x, y, yaw."""
        x, y, yaw = pose
        turn = np.array([(math.cos(yaw), math.sin(yaw)), (-math.sin(yaw), math.cos(yaw))])
        corners = _fixed(self.to_px(length * HEAD @ turn + (x, y)))
        cv2.fillPoly(self.image, [corners], bgr(colour), cv2.LINE_AA, SHIFT)
        cv2.polylines(self.image, [corners], True, (255, 255, 255), 2, cv2.LINE_AA, SHIFT)


def course_plan(track_file: TrackFile, width_px: int, line_colour: str,
                grid: float | None = 0.5) -> Plan:
    """A view of the floor with a grid (m), the two lines and the start."""
    yellow = build_track(track_file)
    white = yellow.offset(-track_file.lane_width)
    points = np.array(yellow.points() + white.points())
    plan = Plan(points.min(axis=0) - 0.15, points.max(axis=0) + 0.15, width_px)
    if grid:
        plan.grid(grid)
    for line, colour in ((white, WHITE), (yellow, line_colour)):
        plan.line(line.points(), colour, max(2, round(track_file.line_width * plan.px_per_m)),
                  closed=True)
    x, y, heading = yellow.pose(0.0)
    across = 0.07 * math.sin(heading), -0.07 * math.cos(heading)
    plan.line(np.add((x, y), np.outer((-1, 1), across)), START, 3)
    return plan


def write_text(image: np.ndarray, text: str, at_px: tuple[int, int], height_px: int,
               colour: tuple = bgr(TEXT)) -> int:
    """Draw text with its baseline's left end at a pixel; returns its width in px."""
    text = text.encode("ascii", "replace").decode()  # cv2 has no other letters
    thick = _thick_px(height_px)
    scale = cv2.getFontScaleFromHeight(FONT, height_px, thick)
    cv2.putText(image, text, at_px, FONT, scale, colour, thick, cv2.LINE_AA)
    return text_width(text, height_px)


def text_width(text: str, height_px: int) -> int:
    """The width of a text of this height, px."""
    thick = _thick_px(height_px)
    scale = cv2.getFontScaleFromHeight(FONT, height_px, thick)
    return cv2.getTextSize(text, FONT, scale, thick)[0][0]


def _thick_px(height_px: int) -> int:
    return 2 if height_px > 24 else 1


LEGEND_PX = 28  # height of a row of a legend


def legend_bar(width_px: int, entries: Iterable[tuple[str, str]]) -> np.ndarray:
    """Rows (n LEGEND_PX, width, 3), BGR, that say in words what colours mean."""
    rows, left = [], width_px
    for text, colour in entries:
        entry = np.full((LEGEND_PX, width_px, 3), bgr(PAPER), np.uint8)
        middle = LEGEND_PX // 2
        cv2.rectangle(entry, (0, middle - 3), (18, middle + 3), bgr(colour), -1)
        wide = 46 + write_text(entry, text, (25, middle + 5), 11)
        if left + wide > width_px and left > 16:
            rows.append(np.full_like(entry, bgr(PAPER)))
            left = 16
        room = rows[-1][:, left:left + wide]
        room[:] = entry[:, :room.shape[1]]
        left += wide
    return np.vstack(rows) if rows else np.full((LEGEND_PX, width_px, 3), bgr(PAPER), np.uint8)


def _fixed(points_px: np.ndarray) -> np.ndarray:
    return np.round(np.asarray(points_px) * (1 << SHIFT)).astype(np.int32)


PANEL_DPI, PANEL = 110, (6.5, 3.4)  # of charts: px an inch; inches
MAP_PX, SIDE_PX, ARROW_PX = 1300, 50, 70  # of a sheet: its maps' width, beside them; the car
THUMBNAIL_PX = 360


def sheet(texts: Sequence[str], plans: Sequence[Plan], entries: Iterable[tuple[str, str]]
          ) -> np.ndarray:
    """A picture (rows, MAP_PX + 2 SIDE_PX, 3), BGR: title and figures, the plans, a legend."""
    page = np.full((70 + 27 * (len(texts) - 1), MAP_PX + 2 * SIDE_PX, 3), bgr(PAPER), np.uint8)
    write_text(page, texts[0], (SIDE_PX, 55), 22)
    for number, text in enumerate(texts[1:], start=1):
        write_text(page, text, (SIDE_PX, 60 + 27 * number), 11, bgr(FAINT))
    legend = legend_bar(MAP_PX, [*entries, ("grid: m", GRID)])
    parts = [*(plan.image for plan in plans), legend]
    return np.vstack([page, *(cv2.copyMakeBorder(
        part, 10, 10, SIDE_PX, SIDE_PX, cv2.BORDER_CONSTANT, value=bgr(PAPER)) for part in parts)])


def write_image(path: Path, picture: np.ndarray) -> None:
    """Write (rows, columns, 3), BGR, as the name ends; OSError, and no file, if it cannot be."""
    write_whole(path, cv2.imencode(path.suffix, picture)[1].tobytes())


def path_picture(track_file: TrackFile, drive: LapScorer, line_colour: str, title: str,
                 subtitle: str) -> np.ndarray:
    """The driven path over the course (rows, 1400, 3), BGR, a colour for each lap."""
    plan = course_plan(track_file, MAP_PX, line_colour)
    entries = [("the line that the car follows", line_colour), ("right edge of the lane", WHITE),
               ("start", START)]
    if drive.samples:
        entries += _draw_laps(plan, drive)
    return sheet((title, subtitle), [plan], entries)


def path_thumbnail(track_file: TrackFile, drive: LapScorer, line_colour: str) -> np.ndarray:
    """The same without words, (rows, THUMBNAIL_PX, 3), BGR, for showing at half this size."""
    plan = course_plan(track_file, THUMBNAIL_PX, line_colour, grid=None)
    _draw_laps(plan, drive, thick_px=5, arrow_px=40)
    return plan.image


def _draw_laps(plan: Plan, drive: LapScorer, thick_px: int = 3, arrow_px: int = ARROW_PX
               ) -> list[tuple[str, str]]:
    """Draw all laps, of which earlier ones are wider, to remain visible; returns the legend's."""
    points = np.array([(sample.x, sample.y) for sample in drive.samples])
    numbers = np.minimum(drive.lap_numbers, drive.wanted_laps - 1)
    last, end, found = numbers[-1], drive.samples[-1], []
    for number in range(last + 1):
        chosen = np.flatnonzero(numbers == number)
        plan.line(points[max(chosen[0] - 1, 0):chosen[-1] + 1], lap_colour(number),
                  round(thick_px * (1 + 0.6 * min(last - number, 4))))
        if number < len(LAPS):
            found.append((f"lap {number + 1}{_lap_figures(drive, number)}", lap_colour(number)))
    if last >= len(LAPS):
        found.append((f"laps {len(LAPS) + 1} to {last + 1}: the same colours again", FAINT))
    plan.arrow((end.x, end.y, end.yaw), arrow_px / plan.px_per_m, CAR)
    return [*found, ("car at the end", CAR)]


def _lap_figures(drive: LapScorer, number: int) -> str:
    if number >= len(drive.laps):
        return ", not closed"
    lap = drive.laps[number]
    return f": {lap.time:.1f} s, {lap.distance:.2f} m, RMS {lap.rms_lateral * 100:.1f} cm"


def write_tiles(path: Path, tiles: Sequence[tuple[str, bool, np.ndarray]], columns: int = 5
                ) -> None:
    """Write tiles side by side: captions, whether they were successes, pictures of one size."""
    shown = []
    for caption, good, picture in tiles:
        head = np.full((24, picture.shape[1], 3), bgr(PAPER), np.uint8)
        write_text(head, caption, (4, 16), 8, bgr(TEXT if good else CAR))
        shown.append(cv2.copyMakeBorder(np.vstack([head, picture]), 0, 6, 3, 3,
                                        cv2.BORDER_CONSTANT, value=bgr(PAPER)))
    columns = min(columns, len(shown))
    shown += [np.full_like(shown[0], bgr(PAPER))] * (-len(shown) % columns)
    write_image(path, np.vstack([np.hstack(shown[first:first + columns])
                                 for first in range(0, len(shown), columns)]))


@contextlib.contextmanager
def chart(path: Path, rows: int, columns: int, **settings: object) -> Iterator[np.ndarray]:
    """A context that yields the Axes (rows, columns) of a chart and writes it at the end."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    sheet = Figure(figsize=(PANEL[0] * columns, PANEL[1] * rows), dpi=PANEL_DPI)
    grid = sheet.subplots(rows, columns, squeeze=False, **settings)
    yield grid
    for axes in grid.flat:
        axes.tick_params(labelsize=8, length=0)
        axes.grid(alpha=0.3)
    sheet.tight_layout()
    canvas = FigureCanvasAgg(sheet)
    canvas.draw()
    write_image(path, np.asarray(canvas.buffer_rgba())[..., 2::-1])
