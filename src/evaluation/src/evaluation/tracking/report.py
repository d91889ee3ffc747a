"""What is written of a drive: report.json, path.png, and the summary at its end."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np

from evaluation.lap import fingerprint
from evaluation.picture import FAINT, GRID, PAPER, draw_line, write_text
from evaluation.session.film import FilmFile
from evaluation.session.frames import frame_figures
from evaluation.session.versions import versions
from evaluation.tracking.options import Options
from evaluation.tracking.room import FAR, NEAR, TARGET, Room
from evaluation.tracking.scene import Scene
from evaluation.tracking.score import BAND, SETTLED, TrackScorer
from evaluation.tracking.start import Start

ROOM_PX, SIDE_PX, HEADER_PX, CURVE_PX, FOOT_PX = 1000, 40, 120, 240, 50
MOST_SHOWN = 1.0  # m beside the wanted distance, at the curve's edges


class Seen(Protocol):
    """What a report needs to know of a run."""

    drive: TrackScorer
    options: Options
    start: Start
    scene: Scene
    frames: tuple[int, int]
    wall: float
    film: FilmFile


def summarize(run: Seen, log: Iterable[str]) -> dict:
    """All figures; m, s, simulated but wall_s."""
    drive, options, log = run.drive, run.options, list(log)
    errors, settled = drive.judged_errors(), drive.judged_errors(SETTLED)
    simulated = drive.elapsed
    return {
        "scene": options.scene, "seed": options.seed, "tracker": options.tracker,
        "fast": options.fast, "outcome": drive.outcome, "good": drive.good,
        "wanted_distance_m": drive.task.wanted, "band_m": BAND,
        "start": {"x": round(run.start.x, 3), "y": round(run.start.y, 3),
                  "yaw_deg": round(math.degrees(run.start.yaw), 1)},
        "approach_s": _rounded(drive.approach, 2),
        "kept_s": round(len(errors) and simulated - drive.approach, 2),
        "left_at_s": _rounded(drive.left_at, 2),
        "rms_error_m": _rounded(np.sqrt(np.mean(errors**2)), 4) if len(errors) else None,
        "max_error_m": _rounded(np.max(np.abs(errors)), 4) if len(errors) else None,
        "max_error_settled_m": _rounded(np.max(np.abs(settled)), 4) if len(settled) else None,
        "share_within_band": (
            round(float(np.mean(np.abs(errors) <= BAND)), 4) if len(errors) else None),
        "hidden": [{"begin_s": round(each.begin, 2), "found_after_s": _rounded(each.found_after, 2)}
                   for each in drive.hidings],
        "least_gap_m": _rounded(drive.least_gap, 3),
        "distance_m": round(drive.distance, 3),
        **frame_figures(*run.frames, log if options.fast else None),
        "drive_sha256": fingerprint(drive),
        "simulated_s": round(simulated, 2), "wall_s": round(run.wall, 2),
        "real_time_factor": round(simulated / run.wall, 2) if run.wall else None,
        "film": run.film.codec or None, "versions": versions(Path(__file__).parent, log),
    }  # fmt: skip


def lines(report: dict) -> list[str]:
    """The summary for a person."""
    found = [f"{report['tracker']}, scene {report['scene']}, seed {report['seed']}: "
             f"{report['outcome']}"]
    near = "never" if report["approach_s"] is None else f"after {report['approach_s']:.1f} s"
    found.append(f"near the cylinder {near}; {report['distance_m']:.2f} m driven in "
                 f"{report['simulated_s']:.1f} s; smallest gap "
                 f"{report['least_gap_m'] * 100:.0f} cm")
    if report["rms_error_m"] is not None:
        found.append(f"beside {report['wanted_distance_m']:g} m: RMS "
                     f"{report['rms_error_m'] * 100:.1f} cm, at most "
                     f"{report['max_error_m'] * 100:.1f} cm ({_cm(report['max_error_settled_m'])} "
                     f"after {SETTLED:g} s), within {BAND:g} m "
                     f"{report['share_within_band']:.1%} of the time")
    for each in report["hidden"]:
        after = each["found_after_s"]
        found.append(f"hidden at {each['begin_s']:.1f} s for 3 s: " + (
            "not found again" if after is None else f"found again after {after:.1f} s"))
    return found


def path_picture(run: Seen, report: dict) -> np.ndarray:
    """The room with both ways, and the distance's curve below it, BGR."""
    drive = run.drive
    width = ROOM_PX + 2 * SIDE_PX
    page = np.full((HEADER_PX + ROOM_PX + CURVE_PX + 2 * FOOT_PX, width, 3), PAPER, np.uint8)
    room = Room(run.scene, 2 * ROOM_PX).draw(drive.samples, drive.errors, drive.task)
    room = cv2.resize(room, (ROOM_PX, ROOM_PX), interpolation=cv2.INTER_AREA)
    page[HEADER_PX:HEADER_PX + ROOM_PX, SIDE_PX:SIDE_PX + ROOM_PX] = room
    title, *figures = lines(report)
    write_text(page, title, (SIDE_PX, 44), 22)
    for number, text in enumerate(figures[:2]):
        write_text(page, text, (SIDE_PX, 76 + 26 * number), 13, FAINT)
    _draw_curve(page[HEADER_PX + ROOM_PX + FOOT_PX:][:CURVE_PX], drive)
    key = [("red: the cylinder", TARGET)]
    if drive.task.wanted:
        key += [(f"green: within {BAND:g} m of the wanted distance", NEAR), ("orange: not", FAR)]
    x = SIDE_PX
    for text, colour in key:
        x += write_text(page, text, (x, page.shape[0] - 18), 12, colour) + 30
    return page


def _draw_curve(image: np.ndarray, drive: TrackScorer) -> None:
    """m beside the wanted distance (or to the cylinder) over s, into the picture's part."""
    height, width = image.shape[:2]
    times = np.array([each.time for each in drive.samples]) - drive.samples[0].time
    left, right = SIDE_PX + 40, width - SIDE_PX
    low, high = (-MOST_SHOWN, MOST_SHOWN) if drive.task.wanted else (0.0, max(drive.errors))

    def px(time: object, error: object) -> np.ndarray:
        x = left + (right - left) * np.asarray(time) / max(times[-1], 1e-6)
        y = (high - np.clip(error, low, high)) / max(high - low, 1e-6) * (height - 1)
        return np.stack(np.broadcast_arrays(x, y), axis=-1)

    marks = (-BAND, 0.0, BAND) if drive.task.wanted else (0.0,)
    for mark in marks:
        draw_line(image, px(times[[0, -1]], mark), GRID if mark else FAINT, 2)
        write_text(image, f"{mark:+.1f} m", (6, int(px(0.0, mark)[1]) + 5), 10, FAINT)
    for begin in drive.task.hidden:
        since = begin - drive.samples[0].time
        if since + 3 < times[-1]:
            draw_line(image, px([since, since + 3], low * 0.95), (200, 160, 110), 8)
            write_text(image, "hidden", (int(px(since, low)[0]), height - 14), 10, FAINT)
    near = np.abs(drive.errors) <= BAND
    points = px(times, drive.errors)
    borders = [0, *(np.flatnonzero(np.diff(near)) + 1), len(near)]
    for begin, end in itertools.pairwise(borders):
        draw_line(image, points[max(begin - 1, 0):end], NEAR if near[begin] else FAR, 2)
    write_text(image, f"{times[-1]:.0f} s", (width - 2 * SIDE_PX, height // 2 + 20), 10, FAINT)


def _cm(value: float | None) -> str:
    return "-" if value is None else f"{value * 100:.1f} cm"


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None or not math.isfinite(value) else round(float(value), digits)
