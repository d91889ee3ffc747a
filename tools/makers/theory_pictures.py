#!/usr/bin/env python3
"""Draws the theory's pictures from the lessons' own code: images/theory*.png of their packages.

  theory_pictures.py [--out FOLDER]     FOLDER gets PACKAGE-NAME.png instead
"""

import argparse
import importlib.util
import sys
from functools import cache
from pathlib import Path

import cv2
import matplotlib
import numpy as np
from ai_robot_tracking.red_target import Colour, distance_of, find_blobs, red_mask
from driving_courses.course import load_course
from driving_courses.packages import find_file
from driving_courses.randomisation import Randomisation, draw
from driving_courses.simulation import Simulation
from driving_courses.tasks import LapTask
from lane_keeping.binarise import line_mask
from lane_keeping.methods.sliding_windows import plan
from lane_keeping.road_view import road_view
from lane_keeping.settings import load_settings
from matplotlib import pyplot as plt

from exercises.checks import laws, simulated

TOPIC = Path(__file__).resolve().parents[2] / "src" / "learning_topic"
sys.path.insert(0, str(TOPIC / "test"))
import drawn_course  # noqa: E402

YELLOW, GREEN, BLUE, RED, GREY = "#c8a000", "#208040", "#2060c0", "#c03030", "#808080"
WIDTH, HEIGHT = 1920, 1080  # px


@cache
def lesson(name: str):
    """The module of a script of learning_topic."""
    spec = importlib.util.spec_from_file_location(name, TOPIC / "scripts" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def photo() -> np.ndarray:
    """(HEIGHT, WIDTH, 3) BGR: what the waffle's camera sees at the start of the course."""
    course, episode = load_course("line_follow"), draw(Randomisation(), np.random.default_rng(0))
    simulation = Simulation(course, (WIDTH, HEIGHT))
    try:
        simulation.begin(*LapTask(course, 1).begin(episode), episode)
        return cv2.cvtColor(simulation.picture(), cv2.COLOR_RGB2BGR)
    finally:
        simulation.close()


@cache
def laps(law: str) -> np.ndarray:
    """(N, 3) s, px and rad/s of lesson 6 round the drawn course with P alone or with all three."""
    six, seen = lesson("06follower_pid"), []
    follower = object.__new__(six.Follower)
    follower.kp, follower.ki, follower.kd = {
        "P": (0.001, 0.0, 0.0), "PID": (six.KP, six.KI, six.KD)}[law]
    follower.reset()

    def follow(image, time):
        offset_px = six.find_line(image)[0] - WIDTH / 2
        seen.append((time, offset_px, follower.steer(offset_px, time)))
        return six.SPEED, seen[-1][2]

    drawn_course.drive(drawn_course.DrawnCourse(), follow)
    return np.array(seen)


def receive(axes):
    """Lesson 1: one image beside the buffer that it has to fit into."""
    sizes = {f"{w}×{h}": w * h * 3 for w, h in ((640, 480), (1280, 720), (WIDTH, HEIGHT))}
    axes.barh(list(sizes), [size / 2**20 for size in sizes.values()], color=BLUE, height=0.5)
    axes.axvline(2**16 / 2**20, color=RED, label="rospy's default: 65536 bytes")
    axes.axvline(2**24 / 2**20, color=GREEN, label="buff_size=2**24")
    axes.set(xscale="log", xlim=(0.03, 40), xlabel="MiB of one image: width · height · 3 bytes")
    axes.legend(loc="upper left", bbox_to_anchor=(0.05, 1.15), ncols=2)


def channels(axes):
    """Lesson 2: one row of the image, channel by channel."""
    row = photo()[900].astype(int)
    for channel, (name, colour, style) in enumerate((
            ("blue", BLUE, "-"), ("green", GREEN, "-"), ("red", RED, ":"))):
        axes.plot(row[:, channel], style, color=colour, lw=2.5,
                  label=f"image[900, :, {channel}] {name}")
    axes.set(xlabel="column, px", ylabel="brightness", ylim=(-5, 265))
    axes.legend()


def colours(axes):
    """Lesson 3: the yellow line's pixels in less and less light."""
    three = lesson("03follower_color_filter")
    yellow = photo()[three.yellow_mask(photo()) > 0]
    light = np.arange(1.0, 0.04, -0.05)
    dimmed = np.rint(light[:, None, None] * yellow).astype(np.uint8)
    red = dimmed.mean(axis=1)[:, 2]
    hue, saturation, value = cv2.cvtColor(dimmed, cv2.COLOR_BGR2HSV).mean(axis=1).T
    for seen, style, colour, name in (
            (red, "-", RED, "red"), (value, ":", "black", "value"),
            (saturation, "-", GREEN, "saturation"), (hue, "-", YELLOW, "hue")):
        axes.plot(100 * light, seen, style, color=colour, lw=2.5, label=name)
    axes.axhline(three.LOWER_YELLOW[2], color=GREY, ls="--", label="least value in the mask")
    axes.set(xlabel="light, %", ylabel="mean of the line's pixels", xlim=(102, 3))
    axes.legend(loc="center right")


def moments(axes):
    """Lesson 4: how many yellow pixels each column of the band has, and their mean."""
    four = lesson("04follower_line_finder")
    counts = np.count_nonzero(four.yellow_mask(photo()[four.band_rows(HEIGHT)]), axis=0)
    axes.fill_between(np.arange(WIDTH), counts, step="mid", color=YELLOW,
                      label="yellow pixels in the 20 rows")
    column = four.find_line(photo())[0]
    axes.axvline(column, color=RED, label=f"m10 / m00 = {column} px")
    axes.axvline(WIDTH / 2, color=GREY, ls="--", label="the image's middle")
    axes.set(xlabel="column, px", ylabel="pixels", xlim=(0, WIDTH))
    axes.legend()


def proportional(axes):
    """Lesson 5: the law, and what a lap needs of it."""
    lap = laps("P")
    axes.plot(lap[:, 1], lap[:, 2], ".", ms=3, color=BLUE, label="all images of a lap")
    axes.axhline(0, color=GREY, lw=0.8)
    axes.axvline(0, color=GREY, lw=0.8)
    axes.set(xlabel="error e, px to the right", ylabel="turn, rad/s (left positive)")
    axes.legend()


def pid(axes):
    """Lesson 6: the error over a lap, with P alone and with all three."""
    for law, colour in (("P", GREY), ("PID", BLUE)):
        lap = laps(law)
        axes.plot(lap[:, 0], lap[:, 1], color=colour, label=law)
    axes.set(xlabel="time, s", ylabel="error e, px")
    axes.legend()


def arcs(axes):
    """Lesson 7: two points of the line on the floor, and the arcs that lead to them."""
    seven, course = lesson("07follower_ground"), drawn_course.DrawnCourse()
    yaw = np.arctan2(*course.along[130][::-1])
    x, y = course.line[130] + 0.06 * np.array([np.sin(yaw), -np.cos(yaw)])  # beside the line
    points = seven.see_line(course.view((x, y, yaw)).copy(), seven.CAMERA)
    turned = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    line = (course.line - (x, y)) @ turned
    line = line[(np.abs(line[:, 1]) < 0.3) & (np.abs(line[:, 0] - 0.25) < 0.35)]
    axes.plot(*line.T, ".", color=YELLOW, label="the line")
    for (ahead, left), name, colour in zip(points, ("near", "far"), (RED, BLUE)):
        bend = seven.bend_to(ahead, left)
        angle = np.linspace(0, 2 * np.arctan2(left, ahead), 50)
        axes.plot(np.sin(angle) / bend, (1 - np.cos(angle)) / bend, color=colour,
                  label=f"{name} arc, κ = {bend:.2f} 1/m")
        axes.plot(ahead, left, "o", color=colour)
    axes.plot(0, 0, "k>", ms=10)
    axes.set(xlabel="x, m ahead", ylabel="y, m to the left", aspect="equal", xlim=(-0.05, 0.6),
             ylim=(-0.15, 0.1))
    axes.legend(loc="lower left")


sys.path.insert(0, str(Path(__file__).parent))

matplotlib.use("Agg")


def windows(axes):
    """The lane: mask, windows, the two fitted lines and the middle between them."""
    settings = load_settings(find_file("lane_keeping/config/lane_keeping.yaml"))
    picture = next(seen for place, (_, seen) in enumerate(simulated.pictures(40)) if place == 13)
    mask = line_mask(picture, settings)
    found = plan(mask, road_view(settings, *simulated.LANE_SIZE), settings)
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
    axes.axvline(simulated.LANE_SIZE[0] / 2, color=GREY, ls="--")
    axes.set(xlim=(0, simulated.LANE_SIZE[0]), ylim=(len(mask), 0), xlabel="column, px",
             ylabel="row, px")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))


def distance(axes):
    """The tracker: distance of a cylinder over its size in px, by its height and by its width."""
    away, seen = np.arange(0.8, 5.01, 0.2), []
    for each in away:
        picture = laws.view(each, 0.0)
        blob = find_blobs(red_mask(picture, Colour(0, 10, 100, 100)), 6)[0]
        seen.append((blob.height, distance_of(blob, picture.shape[:2], laws.HFOV, laws.RADIUS,
                                              laws.TALL)))
    heights, found = np.array(seen).T
    px = np.linspace(heights.min(), heights.max(), 200)
    axes.plot(px, laws.FOCAL * laws.TALL / px + laws.RADIUS, color=GREY, label="f · H / h + r")
    axes.plot(heights, found, "o", ms=4, color=RED, label="distance_of, on drawn pictures")
    axes.set(xlabel="height h in the picture, px", ylabel="distance d, m")
    axes.legend()


PICTURES = {
    "learning_topic": {"theory01": receive, "theory02": channels,
                       "theory03": colours, "theory04": moments,
                       "theory05": proportional, "theory06": pid,
                       "theory07": arcs},
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
