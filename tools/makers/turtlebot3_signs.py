"""Traffic signs: a board with a drawing of our own on a post, and a checker board."""

from __future__ import annotations

import math
from collections.abc import Callable

import sdf
from painting import (
    BLACK,
    BLUE,
    RED,
    WHITE,
    YELLOW,
    Canvas,
    Point,
)
from sdf import DARK, Part, box, cylinder

SIDE_PX = 128
BOARD, BOARD_THICK = 0.11, 0.004  # m
HIGH = 0.125  # m, of the board's middle above the floor
POST = HIGH - BOARD / 2
P_STROKE: tuple[Point, ...] = ((-0.2, -0.55), (-0.2, 0.55), (0.1, 0.55), (0.25, 0.45),
                               (0.3, 0.28), (0.25, 0.1), (0.1, 0.0), (-0.2, 0.0))

LETTERS: tuple[tuple[Point, ...], ...] = (  # S, T, O, P
    ((0.1, 0.22), (-0.1, 0.22), (-0.1, 0), (0.1, 0), (0.1, -0.22), (-0.1, -0.22)),
    ((-0.13, 0.22), (0.13, 0.22), (0, 0.22), (0, -0.22)),
    ((-0.1, 0.22), (0.1, 0.22), (0.1, -0.22), (-0.1, -0.22), (-0.1, 0.22)),
    ((-0.1, -0.22), (-0.1, 0.22), (0.1, 0.22), (0.1, 0), (-0.1, 0)),
)


def ring(corners: int, radius: float, turn: float = 0.0) -> list[Point]:
    """A regular polygon."""
    angles = [turn + math.tau * i / corners for i in range(corners)]
    return [(radius * math.cos(a), radius * math.sin(a)) for a in angles]


def disc(canvas: Canvas, colour) -> None:
    canvas.stroke([(0, 0)], 1.9, WHITE)
    canvas.stroke([(0, 0)], 1.75, colour)


def arrow(canvas: Canvas, side: float) -> None:
    """Up and then to one side: 1 is to the right."""
    canvas.stroke([(-side * 0.3, -0.5), (-side * 0.3, 0.15), (side * 0.2, 0.15)], 0.2, WHITE)
    canvas.fill([(side * 0.15, 0.5), (side * 0.6, 0.15), (side * 0.15, -0.2)], WHITE)


def triangle(canvas: Canvas) -> None:
    canvas.fill([(-0.95, -0.8), (0.95, -0.8), (0, 0.9)], RED)
    canvas.fill([(-0.68, -0.64), (0.68, -0.64), (0, 0.56)], YELLOW)


def parking(canvas: Canvas) -> None:
    canvas.stroke(P_STROKE, 0.2, WHITE)


def parking_left(canvas: Canvas) -> None:
    canvas.stroke([(x * 0.75 + 0.35, y * 0.75) for x, y in P_STROKE], 0.17, WHITE)
    canvas.stroke([(-0.1, 0), (-0.55, 0)], 0.15, WHITE)
    canvas.fill([(-0.5, 0.28), (-0.9, 0), (-0.5, -0.28)], WHITE)


def tunnel(canvas: Canvas) -> None:
    canvas.stroke([*((0.6 * x, 0.6 * y + 0.05) for x, y in ring(24, 1.0)[:13])], 0.16, WHITE)
    canvas.stroke([(-0.6, 0.05), (-0.6, -0.65)], 0.16, WHITE)
    canvas.stroke([(0.6, 0.05), (0.6, -0.65)], 0.16, WHITE)
    canvas.fill([(-0.38, -0.7), (0.38, -0.7), (0.1, 0.15), (-0.1, 0.15)], WHITE)


def stop(canvas: Canvas) -> None:
    canvas.fill(ring(8, 1.0, math.tau / 16), WHITE)
    canvas.fill(ring(8, 0.92, math.tau / 16), RED)
    for i, points in enumerate(LETTERS):
        canvas.stroke([(x + 0.37 * i - 0.555, y) for x, y in points], 0.09, WHITE)


def construction(canvas: Canvas) -> None:
    triangle(canvas)
    canvas.fill([(0.05, -0.5), (0.5, -0.5), (0.28, -0.2)], BLACK)
    canvas.stroke([(-0.15, 0.16)], 0.16, BLACK)
    canvas.stroke([(-0.3, -0.5), (-0.2, -0.2), (-0.12, 0.0), (0.05, -0.1)], 0.09, BLACK)
    canvas.stroke([(-0.05, -0.02), (0.2, -0.3)], 0.05, BLACK)


def intersection(canvas: Canvas) -> None:
    triangle(canvas)
    canvas.stroke([(0, -0.5), (0, 0.2)], 0.16, BLACK)
    canvas.stroke([(-0.3, -0.2), (0.3, -0.2)], 0.16, BLACK)


def no_entry(canvas: Canvas) -> None:
    disc(canvas, RED)
    canvas.stroke([(-0.5, 0), (0.5, 0)], 0.26, WHITE)


def turn_left(canvas: Canvas) -> None:
    disc(canvas, BLUE)
    arrow(canvas, -1)


def turn_right(canvas: Canvas) -> None:
    disc(canvas, BLUE)
    arrow(canvas, 1)


# Name: background, drawing, and where the board's middle stands in the model. What the world files
# include stands at its own origin; what is spawned while the race is on brings its place with it.
Drawing = Callable[[Canvas], None]
GREY, AT_CORNER = (120, 120, 120), (1.747, -0.58, 0.125)
SIGNS: dict[str, tuple[tuple[int, int, int], Drawing, sdf.Numbers]] = {
    "traffic_parking": (BLUE, parking, sdf.ORIGIN),
    "traffic_tunnel": (BLUE, tunnel, sdf.ORIGIN),
    "traffic_stop": (GREY, stop, sdf.ORIGIN),
    "traffic_pl_left": (BLUE, parking_left, sdf.ORIGIN),
    "traffic_construction": (GREY, construction, sdf.ORIGIN),
    "traffic_intersection": (GREY, intersection, sdf.ORIGIN),
    "traffic_noentry": (GREY, no_entry, sdf.ORIGIN),
    "traffic_left": (GREY, turn_left, AT_CORNER),
    "traffic_right": (GREY, turn_right, AT_CORNER),
}
SIGNS_2017 = ("traffic_parking", "traffic_tunnel", "traffic_stop")


def picture(name: str) -> bytes:
    """The sign's drawing as PNG."""
    background, draw, _ = SIGNS[name]
    canvas = Canvas(SIDE_PX, 2.0, background)
    draw(canvas)
    return canvas.png()


def sign(folder: str, name: str) -> dict[str, bytes]:
    """A model of one sign: the board's faces look along -y and +y."""
    place = SIGNS[name][2]
    parts = [
        Part("board", box(BOARD, BOARD_THICK, BOARD), texture=f"model://{folder}/{name}",
             material=name),
        Part("post", box(0.012, 0.012, POST), (0, 0, -BOARD / 2 - POST / 2), DARK),
        Part("foot", cylinder(0.03, 0.01), (0, 0, -HIGH + 0.005), DARK),
    ]
    text = sdf.model(name, [sdf.link("link", parts, place)])
    files = sdf.model_files(f"{folder}/{name}", text, "A traffic sign on a post.")
    return files | sdf.material_files(f"{folder}/{name}", name, picture(name))


def checker(folder: str) -> dict[str, bytes]:
    """A board of 8 x 8 squares of 0.15 m, standing upright across x: for a camera's calibration."""
    canvas, name = Canvas(256, 8.0, WHITE), "checker"
    for row in range(8):
        for column in range(row % 2, 8, 2):
            x, y = column - 4, row - 4
            canvas.fill([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)], BLACK)
    part = Part("board", box(0.02, 1.2, 1.2), (0, 0, 0.6), texture=f"model://{folder}/{name}",
                material=name)
    files = sdf.model_files(f"{folder}/{name}", sdf.model(name, [sdf.link("link", [part])]),
                            "An upright board of black and white squares.")
    return files | sdf.material_files(f"{folder}/{name}", name, canvas.png())


def signs() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    files = checker("turtlebot3_autorace_2020")
    for name in SIGNS_2017:
        files |= sign("turtlebot3_autorace", name)
    for name in SIGNS:
        files |= sign("turtlebot3_autorace_2020", name)
    return files
