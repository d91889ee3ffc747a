#!/usr/bin/env python3
"""Drives a lap of the course and one of the racetrack, and writes README's looping picture.

  loop_picture.py [--out FILE] [--runs DIR]

Side by side: what the camera sees with the line found, the car from outside as run.html shows it in
Chromium, and the path so far. A DIR with runs is used again: nothing is driven a second time.
"""

from __future__ import annotations

import argparse
import io
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from evaluation.course_run import PLAN_PX, legend_entries
from evaluation.film import BAR_PX, FILM_RATE_HZ, VIEW_PX
from evaluation.picture import LEGEND_PX, PAPER, bgr, legend_bar, write_text
from run_session.course_file import load_course

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "src/sim/sim_viewer/test"))  # the tests' browsers
PANEL_PX, PATH_PX, GAP_PX = (320, 180), (264, 180), 6  # width, height
TITLES = {"course": "make course: TurtleBot3 waffle, lesson 05", "race": "make race: racecar"}
LAST_S, QUALITY = 1.5, 75  # how long a lap's last picture stays; of WebP
STILL_S, STILL_LIMIT = 0.6, 30.0  # s, wall, between two looks at a page, and until it is still


def main() -> int:
    """The exit status: 0, or that of a drive that did not close its lap."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "docs/images/course.webp")
    parser.add_argument("--runs", type=Path, default=ROOT / "out/loop_picture")
    options = parser.parse_args()
    pictures: list[np.ndarray] = []
    ends: list[int] = []
    for course in TITLES:
        run = options.runs / course
        if not (run / "run.html").exists():
            done = subprocess.run([
                "rosrun", "evaluation", "course_run.py", "--course", course, "--fast", "--seed",
                "1", "--out", str(run)], check=False)
            if done.returncode:
                return done.returncode
        pages = list(film_pages(run / "run.mp4"))
        pictures += [lap_picture(course, page, outside) for page, outside in zip(
            pages, outside_views(run / "run.html", len(pages)), strict=True)]
        ends.append(len(pictures) - 1)
    options.out.write_bytes(animation(pictures, ends))
    print(f"{options.out}: {options.out.stat().st_size} bytes, {len(pictures)} pictures")
    return 0


def film_pages(path: Path) -> Iterator[np.ndarray]:
    """The pictures of a run's film, BGR."""
    film = cv2.VideoCapture(str(path))
    while (read := film.read())[0]:
        yield read[1]


def outside_views(path: Path, count: int) -> Iterator[np.ndarray]:
    """`count` moments of a run from outside, as its page shows them, BGR."""
    import chromium  # of the path above

    browser = chromium.Browser()
    try:
        page = browser.open(path.resolve().as_uri())
        page.resize(1600, 900)
        page.wait_for("document.querySelector('.hint')?.hidden")
        left, top, width, height = page.evaluate(
            "document.querySelector('.views').hidden = true;"
            "document.querySelector('.views').style.display = 'none';"
            "box = document.querySelector('.view canvas').getBoundingClientRect();"
            "[box.left, box.top, box.width, box.height].map(Math.round)")
        for number in range(count):
            page.evaluate(
                "slider = document.querySelector('#time');"
                f"slider.value = +slider.min + (slider.max - slider.min) * {number / count};"
                "slider.dispatchEvent(new Event('input'))")
            yield _still(page)[top:top + height, left:left + width]
    finally:
        browser.close()


def _still(page: object) -> np.ndarray:
    """What a page shows when nothing changes any more."""
    until, before = time.monotonic() + STILL_LIMIT, page.picture()
    while time.monotonic() < until:
        time.sleep(STILL_S)
        now = page.picture()
        if np.array_equal(now, before):
            break
        before = now
    return before


def lap_picture(course: str, page: np.ndarray, outside: np.ndarray) -> np.ndarray:
    """Camera and path of the film's picture, and the view from outside between them, BGR."""
    camera = page[BAR_PX:BAR_PX + VIEW_PX[1], :VIEW_PX[0]]
    path = page[BAR_PX:page.shape[0] - LEGEND_PX, VIEW_PX[0]:VIEW_PX[0] + PLAN_PX]
    parts = [into(camera, PANEL_PX), into(outside, PANEL_PX, cover=True), into(path, PATH_PX)]
    gap = np.full((PANEL_PX[1], GAP_PX, 3), bgr(PAPER), np.uint8)
    row = np.hstack([parts[0], gap, parts[1], gap, parts[2]])
    title = np.full((LEGEND_PX, row.shape[1], 3), bgr(PAPER), np.uint8)
    write_text(title, TITLES[course], (10, 19), 12)
    marked, lines = legend_entries(load_course(course))
    legend = legend_bar(row.shape[1], [*marked, *lines])
    return np.vstack([title, row, legend])


def into(picture: np.ndarray, size: tuple[int, int], cover: bool = False) -> np.ndarray:
    """The picture as large as fits into `size` (width, height), or so that it covers it."""
    choose = max if cover else min
    scale = choose(size[0] / picture.shape[1], size[1] / picture.shape[0])
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    height, width = small.shape[:2]
    left, top = (width - size[0]) // 2, (height - size[1]) // 2
    if cover:
        return small[top:top + size[1], left:left + size[0]]
    box = np.full((size[1], size[0], 3), bgr(PAPER), np.uint8)
    box[-top:-top + height, -left:-left + width] = small[:size[1], :size[0]]
    return box


def animation(pictures: Sequence[np.ndarray], ends: Sequence[int]) -> bytes:
    """A WebP that loops; those in `ends` stay longer."""
    frames = [Image.fromarray(np.ascontiguousarray(picture[..., ::-1])) for picture in pictures]
    stays = [round(1000 * (LAST_S if number in ends else 1 / FILM_RATE_HZ))
             for number in range(len(frames))]
    made = io.BytesIO()
    frames[0].save(made, "WEBP", save_all=True, append_images=frames[1:], duration=stays, loop=0,
                   quality=QUALITY, method=6)
    return made.getvalue()


if __name__ == "__main__":
    sys.exit(main())
