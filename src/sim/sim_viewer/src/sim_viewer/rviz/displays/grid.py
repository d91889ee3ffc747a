"""rviz/Grid: lines on the ground, and rviz/Axes: a cross of axes."""

from collections.abc import Callable
from typing import Any

import numpy as np

from bullet_sim.pose import IDENTITY
from sim_viewer.rviz.colours import rgba
from sim_viewer.rviz.display_type import DisplayType, Drawer, View
from sim_viewer.rviz.displays.path import STYLES
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import axes, lines
from sim_viewer.rviz.options import FIXED_FRAME, Option

PLANES = {"XY": (0, 1), "XZ": (0, 2), "YZ": (1, 2)}
PERIOD = 0.5  # s between look-ups of the reference frame's pose
FRAME = Option("Reference Frame", "frame", FIXED_FRAME)


class Fixed(Drawer):
    """Something that never changes, at a reference frame."""

    def __init__(self, options: dict[str, Any], build: Callable[[dict[str, Any]], list[Part]]):
        super().__init__(options)
        self._build = build

    def draw(self, view: View) -> list[Part]:
        frame = self.options["Reference Frame"]
        pose = IDENTITY if frame in ("", FIXED_FRAME) else view.pose(frame)
        parts = self._build(self.options)
        for part in parts:
            part.pose = pose
        return parts


def grid_lines(options: dict[str, Any]) -> list[Part]:
    """A grid of as many cells as the options say, centred on the frame's origin."""
    cells, size = options["Plane Cell Count"], options["Cell Size"]
    half = cells * size / 2
    places = np.linspace(-half, half, cells + 1)
    edge = np.full_like(places, half)
    across = [np.stack([places, -edge], 1), np.stack([places, edge], 1)]
    flat = np.concatenate([np.stack(across, 1), np.stack(across, 1)[..., ::-1]]).reshape(-1, 2)
    positions = np.zeros((len(flat), 3))
    first, second = PLANES[options["Plane"]]
    positions[:, first], positions[:, second] = flat[:, 0], flat[:, 1]
    positions += [options[f"Offset/{axis}"] for axis in "XYZ"]
    wide = options["Line Style/Value"] == "Billboards"
    return [lines(positions, rgba(options), options["Line Style/Line Width"] if wide else 0.0)]


def cross(options: dict[str, Any]) -> list[Part]:
    """Axes at the reference frame's origin."""
    row = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    return axes(row, options["Length"], options["Radius"])


GRID = DisplayType(
    "rviz/Grid", lambda options: Fixed(options, grid_lines), period=PERIOD, options=(
        FRAME, Option("Plane Cell Count", "integer", 10, low=1, high=1000),
        Option("Cell Size", "number", 1.0, low=1e-4), Option("Color", "color", "160; 160; 164"),
        Option("Alpha", "number", 0.5, high=1), Option("Plane", "choice", "XY", tuple(PLANES)),
        Option("Line Style/Value", "choice", "Lines", STYLES),
        Option("Line Style/Line Width", "number", 0.03, high=10),
        *(Option(f"Offset/{axis}", "number", 0.0, low=-1e6) for axis in "XYZ")))
AXES = DisplayType(
    "rviz/Axes", lambda options: Fixed(options, cross), period=PERIOD, options=(
        FRAME, Option("Length", "number", 1.0), Option("Radius", "number", 0.1)))
