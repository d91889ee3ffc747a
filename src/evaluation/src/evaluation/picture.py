"""Pictures of the course from above, in pixels: the map, the car on it, and the path driven."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import cv2
import numpy as np

from evaluation.lap import LapScorer
from evaluation.track import TrackFile, build_track

FLOOR, YELLOW, WHITE = (16, 14, 14), (40, 215, 245), (225, 225, 225)  # BGR, as all pictures here
PAPER, GRID, TEXT, FAINT = (30, 26, 24), (44, 39, 36), (235, 232, 228), (165, 158, 152)
LAP_COLOURS = (
    (240, 170, 70),
    (110, 110, 250),
    (130, 210, 90),
    (220, 120, 210),
    (90, 190, 250),
    (200, 200, 80),
)
FONT = cv2.FONT_HERSHEY_DUPLEX
LEGEND_WIDTH_PX = 440
SHIFT = 4  # cv2 draws between pixels when coordinates are given in sixteenths


class CourseMap:
    """The course seen from above, drawn to fit a width; world coordinates in m, y up."""

    def __init__(self, track_file: TrackFile, width_px: int, margin: float = 0.15):
        self._yellow = build_track(track_file)
        self._white = self._yellow.offset(-track_file.lane_width)
        self._line_width = track_file.line_width
        points = np.array(self._yellow.points() + self._white.points())
        self._low, self._high = points.min(axis=0) - margin, points.max(axis=0) + margin
        self.px_per_m = width_px / (self._high[0] - self._low[0])
        self.width_px = width_px
        self.height_px = round((self._high[1] - self._low[1]) * self.px_per_m)

    def to_px(self, points: Iterable[tuple[float, float]]) -> np.ndarray:
        """World points (n, 2) as pixel coordinates (n, 2), float."""
        points = np.asarray(points, float).reshape(-1, 2)
        return (points - (self._low[0], self._high[1])) * (self.px_per_m, -self.px_per_m)

    def empty(self) -> np.ndarray:
        """The floor with its grid of half metres and the two lines."""
        image = np.full((self.height_px, self.width_px, 3), FLOOR, np.uint8)
        for axis in (0, 1):
            for k in range(math.ceil(self._low[axis] * 2), math.floor(self._high[axis] * 2) + 1):
                ends = np.array((self._low, self._high))
                ends[:, axis] = k / 2
                draw_line(image, self.to_px(ends), GRID, 1)
        thick = max(2, round(self._line_width * self.px_per_m))
        for line, colour in ((self._white, WHITE), (self._yellow, YELLOW)):
            draw_line(image, self.to_px(line.points()), colour, thick, closed=True)
        self._mark_start(image)
        return image

    def _mark_start(self, image: np.ndarray) -> None:
        x, y, heading = self._yellow.pose(0.0)
        across = np.array((math.sin(heading), -math.cos(heading)))
        ends = [(x, y) - 0.07 * across, (x, y) + 0.07 * across]
        draw_line(image, self.to_px(ends), TEXT, max(2, round(0.012 * self.px_per_m)))

    def draw_car(self, image: np.ndarray, x: float, y: float, yaw: float) -> None:
        """A red arrow head, 0.2 m long, with its reference point at x, y."""
        shape = np.array([(0.12, 0.0), (-0.08, 0.075), (-0.04, 0.0), (-0.08, -0.075)])
        turn = np.array([(math.cos(yaw), math.sin(yaw)), (-math.sin(yaw), math.cos(yaw))])
        corners = _fixed_point(self.to_px(shape @ turn + (x, y)))
        cv2.fillPoly(image, [corners], (60, 60, 240), cv2.LINE_AA, SHIFT)
        cv2.polylines(image, [corners], True, (255, 255, 255), 1, cv2.LINE_AA, SHIFT)


def draw_line(
    image: np.ndarray, points_px: np.ndarray, colour: tuple, thick_px: int, closed: bool = False
) -> None:
    """An anti-aliased line through points between pixels."""
    cv2.polylines(image, [_fixed_point(points_px)], closed, colour, thick_px, cv2.LINE_AA, SHIFT)


def write_text(
    image: np.ndarray, text: str, at_px: tuple[int, int], height_px: int, colour: tuple = TEXT
) -> int:
    """Text with its base line's left end at a pixel; returns its width in px."""
    thick = 2 if height_px > 24 else 1
    scale = cv2.getFontScaleFromHeight(FONT, height_px, thick)
    cv2.putText(image, text, at_px, FONT, scale, colour, thick, cv2.LINE_AA)
    return cv2.getTextSize(text, FONT, scale, thick)[0][0]


def path_picture(
    track_file: TrackFile, drive: LapScorer, title: str, subtitle: str, width_px: int = 1400
) -> np.ndarray:
    """The driven path over the course, a colour for each lap, with title, legend and scale."""
    fine = 2  # drawn larger and shrunk, so that letters and curves are smooth
    course = CourseMap(track_file, (width_px - 80) * fine)
    floor = course.empty()
    laps = _draw_path(course, floor, drive, thick_px=3 * fine)
    _draw_legend(floor, drive, laps, fine)
    if drive.samples:
        last = drive.samples[-1]
        course.draw_car(floor, last.x, last.y, last.yaw)
    header, foot = 130 * fine, 70 * fine
    page = np.full((course.height_px + header + foot, width_px * fine, 3), PAPER, np.uint8)
    page[header : header + course.height_px, 40 * fine : -40 * fine] = floor
    write_text(page, title, (40 * fine, 62 * fine), 26 * fine)
    write_text(page, subtitle, (40 * fine, 102 * fine), 15 * fine, FAINT)
    _draw_scale(page, course.px_per_m, (40 * fine, header + course.height_px + 36 * fine), fine)
    size = (page.shape[1] // fine, page.shape[0] // fine)
    return cv2.resize(page, size, interpolation=cv2.INTER_AREA)


def _draw_path(course: CourseMap, image: np.ndarray, drive: LapScorer, thick_px: int) -> int:
    """Draw the samples lap by lap; returns how many colours were needed."""
    if not drive.samples:
        return 0
    points = course.to_px([(sample.x, sample.y) for sample in drive.samples])
    numbers = np.minimum(drive.lap_numbers, drive.wanted_laps - 1)
    for number in range(numbers[-1] + 1):
        chosen = np.flatnonzero(numbers == number)
        first, last = max(chosen[0] - 1, 0), chosen[-1]
        # Laps lie on one another: earlier ones are wider, so that they show beside later ones.
        wider = 1 + 0.6 * min(numbers[-1] - number, 4)
        draw_line(image, points[first : last + 1], lap_colour(number), round(thick_px * wider))
    return int(numbers[-1]) + 1


def lap_colour(number: int) -> tuple[int, int, int]:
    """The colour (BGR) of a lap, counted from 0."""
    return LAP_COLOURS[number % len(LAP_COLOURS)]


def _draw_legend(image: np.ndarray, drive: LapScorer, laps: int, fine: int) -> None:
    """What the lines mean, where the course leaves room for it."""
    entries = [
        (YELLOW, "yellow: what the car follows"),
        (WHITE, "white: right edge of the lane"),
    ]
    shown = min(laps, len(LAP_COLOURS))
    for number in range(shown):
        entries.append((lap_colour(number), f"lap {number + 1}{_lap_figures(drive, number)}"))
    if laps > shown:
        entries.append((FAINT, f"laps {shown + 1} to {laps}: the same colours again"))
    step = 30 * fine
    left, top = _free_place(image, (LEGEND_WIDTH_PX * fine, step * len(entries)))
    top += step // 2
    for row, (colour, text) in enumerate(entries):
        y = top + row * step
        ends = np.array([(left, y), (left + 44 * fine, y)])
        draw_line(image, ends, colour, 5 * fine)
        write_text(image, text, (left + 60 * fine, y + 6 * fine), 13 * fine)


def _free_place(image: np.ndarray, size_px: tuple[int, int]) -> tuple[int, int]:
    """Left and top of a box (width, height) that covers no line, as near the middle as may be."""
    width, height = size_px
    drawn = cv2.integral((image.max(axis=2) > max(GRID) + 16).astype(np.uint8))
    lefts = np.arange(0, image.shape[1] - width, 16)
    tops = np.arange(0, image.shape[0] - height, 16)[:, None]
    lines = (drawn[tops + height, lefts + width] - drawn[tops, lefts + width]
             - drawn[tops + height, lefts] + drawn[tops, lefts])  # fmt: skip
    away = np.hypot(lefts + width / 2 - image.shape[1] / 2, tops + height / 2 - image.shape[0] / 2)
    best = np.argmin(lines * 1e6 + away)
    row, column = np.unravel_index(best, away.shape)
    return int(lefts[column]), int(tops[row, 0])


def _lap_figures(drive: LapScorer, number: int) -> str:
    if number >= len(drive.laps):
        return ", not closed"
    lap = drive.laps[number]
    return f": {lap.time:.1f} s, {lap.distance:.2f} m, RMS {lap.rms_lateral * 100:.1f} cm"


def _draw_scale(image: np.ndarray, px_per_m: float, at_px: tuple[int, int], fine: int) -> None:
    x, y = at_px
    end = x + round(px_per_m / 2)
    for points in (((x, y), (end, y)), ((x, y - 8), (x, y + 8)), ((end, y - 8), (end, y + 8))):
        draw_line(image, np.array(points), FAINT, 2 * fine)
    write_text(image, "0.5 m", (end + 14 * fine, y + 6 * fine), 13 * fine, FAINT)


def _fixed_point(points_px: np.ndarray) -> np.ndarray:
    return np.round(np.asarray(points_px) * (1 << SHIFT)).astype(np.int32)


def tile_sheet(tiles: Sequence[np.ndarray], columns: int, gap_px: int) -> np.ndarray:
    """Pictures (height, width, 3) of one size, row by row, with gaps between and round them."""
    height, width = tiles[0].shape[:2]
    columns, rows = min(columns, len(tiles)), -(-len(tiles) // columns)
    sheet = np.full((rows * (height + gap_px) + gap_px, columns * (width + gap_px) + gap_px, 3),
                    PAPER, np.uint8)
    for number, tile in enumerate(tiles):
        row, column = divmod(number, columns)
        top, left = gap_px + row * (height + gap_px), gap_px + column * (width + gap_px)
        sheet[top:top + height, left:left + width] = tile
    return sheet
