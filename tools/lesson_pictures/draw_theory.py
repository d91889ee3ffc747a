#!/usr/bin/env python3
"""Draws the theory's pictures from the lessons' own code: images/theory*.png of their packages.

  draw_theory.py [--out FOLDER]     FOLDER gets PACKAGE-NAME.png instead
"""

import argparse
import sys
from pathlib import Path

import matplotlib
import numpy as np
from ai_robot_tracking.red_target import Colour, distance_of, find_blobs, red_mask
from driving_courses.packages import find_file
from lane_keeping.binarise import line_mask
from lane_keeping.methods.sliding_windows import plan
from lane_keeping.road_view import road_view
from lane_keeping.settings import load_settings
from matplotlib import pyplot as plt

from exercises.checks import lane, stop

sys.path.insert(0, str(Path(__file__).parent))
import theory_followers as followers
from theory_followers import BLUE, GREEN, GREY, RED, TOPIC, YELLOW

matplotlib.use("Agg")


def windows(axes):
    """The lane: mask, windows, the two fitted lines and the middle between them."""
    settings = load_settings(find_file("lane_keeping/config/lane_keeping.yaml"))
    picture = next(seen for place, (_, seen) in enumerate(lane.pictures(40)) if place == 13)
    mask = line_mask(picture, settings)
    found = plan(mask, road_view(settings, *lane.SIZE), settings)
    axes.imshow(255 - mask // 2, cmap="gray", vmin=0, vmax=255)
    for left, top, right, bottom in found.lane.marks.boxes:
        axes.add_patch(plt.Rectangle((left, top), right - left, bottom - top, fill=False,
                                     color=GREEN, lw=0.8))
    for side, colour, name in ((found.lane.left, BLUE, "left line l(r)"),
                               (found.lane.right, RED, "right line"),
                               (found.lane.centre, YELLOW, "middle c(r)")):
        rows = np.linspace(*side.rows, 60)
        axes.plot(np.polyval(side.curve, rows), rows, color=colour, lw=2, label=name)
    axes.plot(*found.target, "o", color=YELLOW, mec="k", label="look-ahead row")
    axes.axvline(lane.SIZE[0] / 2, color=GREY, ls="--")
    axes.set(xlim=(0, lane.SIZE[0]), ylim=(len(mask), 0), xlabel="column, px", ylabel="row, px")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))


def distance(axes):
    """The tracker: how far away a cylinder of so many px is, by its height and by its width."""
    away, seen = np.arange(0.8, 5.01, 0.2), []
    for each in away:
        picture = stop.view(each, 0.0)
        blob = find_blobs(red_mask(picture, Colour(0, 10, 100, 100)), 6)[0]
        seen.append((blob.height, distance_of(blob, picture.shape[:2], stop.HFOV, stop.RADIUS,
                                              stop.TALL)))
    heights, found = np.array(seen).T
    px = np.linspace(heights.min(), heights.max(), 200)
    axes.plot(px, stop.FOCAL * stop.TALL / px + stop.RADIUS, color=GREY, label="f · H / h + r")
    axes.plot(heights, found, "o", ms=4, color=RED, label="distance_of, on drawn pictures")
    axes.set(xlabel="height h in the picture, px", ylabel="distance d, m")
    axes.legend()


PICTURES = {
    "learning_topic": {"theory01": followers.receive, "theory02": followers.channels,
                       "theory03": followers.colours, "theory04": followers.moments,
                       "theory05": followers.proportional, "theory06": followers.pid,
                       "theory07": followers.arcs},
    "lane_keeping": {"theory": windows},
    "ai_robot_tracking": {"theory": distance},
}


def listed():
    """(package, its folder of images, picture's name, what draws it) of each."""
    for package, pictures in PICTURES.items():
        folder = TOPIC if package == "learning_topic" else TOPIC.parent / "lessons" / package
        for name, draw_into in pictures.items():
            yield package, folder / "images", name, draw_into


def write(draw_into, path: Path) -> None:
    """One picture of 640 by 300 px; same code, same bytes."""
    with matplotlib.rc_context({"font.size": 9, "legend.fontsize": 8}):
        figure, axes = plt.subplots(figsize=(6.4, 3.0), dpi=100, layout="constrained")
        draw_into(axes)
        figure.savefig(path, metadata={"Software": None})
        plt.close(figure)


def main() -> None:
    """All pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, metavar="FOLDER")
    out = parser.parse_args().out
    for package, folder, name, draw_into in listed():
        path = out / f"{package}-{name}.png" if out else folder / f"{name}.png"
        write(draw_into, path)
        print(path)


if __name__ == "__main__":
    main()
