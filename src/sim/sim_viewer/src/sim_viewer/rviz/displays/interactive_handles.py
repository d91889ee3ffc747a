"""Default shapes for controls of interactive markers that have no markers of their own.

Sizes and colours are those of rviz: arrows for moving along an axis, a ring for rotating or moving
in a plane, text for a menu.
"""

from typing import Any

import numpy as np

from bullet_sim.pose import Pose, Quaternion
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import arrows, multiplied, turned

NONE, MENU, BUTTON, MOVE_AXIS, MOVE_PLANE, ROTATE_AXIS, MOVE_ROTATE = range(7)
MODES = 10  # with the 3D modes
INHERIT, FIXED, VIEW_FACING = range(3)
# In units of the marker's size.
SHAFT, HEAD = (0.2, 0.15), (0.2, 0.25)  # length and diameter
BEGIN = 0.5  # of an arrow
INNER, OUTER = 0.5, 0.65  # radii of a ring
MENU_HEIGHT, MENU_ABOVE = 0.25, 1.175
TITLE_HEIGHT, TITLE_ABOVE = 0.15, 1.4
SIDES = 36  # of a ring
ALPHA = 0.5
SHADES = (0.6, 1.0)  # of a ring's segments in turn, so that its rotation is visible
LONGEST_TEXT = 1000
BACKWARDS = np.array([0.0, 0.0, 1.0, 0.0])  # turns x to -x


def handle_parts(mode: int, orientation: Quaternion, size: float, text: str) -> list[Part]:
    """The parts of a control with the x axis of `orientation`, of a marker of `size` m."""
    if mode == MOVE_AXIS:
        return _two_arrows(orientation, size)
    if mode in (MOVE_PLANE, ROTATE_AXIS, MOVE_ROTATE):
        return [_ring(mode, orientation, size)]
    if mode == MENU and text.strip():
        return [words(text, MENU_ABOVE * size, MENU_HEIGHT * size)]
    return []


def words(text: str, above: float, height: float) -> Part:
    """White text of `height` m, `above` m over the marker."""
    return Part("texts", fields={"texts": [{
        "text": text[:LONGEST_TEXT], "position": [0.0, 0.0, above], "height": height,
        "colour": [255, 255, 255, 255]}]})


def colour_of(orientation: Quaternion) -> np.ndarray:
    """(4,) of 0 to 255: red, green or blue as the axis is x, y or z."""
    axis = np.abs(turned(np.array([orientation]), np.array([[1.0, 0.0, 0.0]]))[0])
    return np.round(255 * np.array([*(axis / axis.max()), ALPHA]))


def _two_arrows(orientation: Quaternion, size: float) -> list[Part]:
    turns = np.stack([orientation, multiplied(np.array(orientation), BACKWARDS)])
    starts = turned(turns, np.tile([BEGIN * size, 0.0, 0.0], (2, 1)))
    shaft, head = (tuple(size * one for one in part) for part in (SHAFT, HEAD))
    return arrows(np.hstack([starts, turns]), shaft, head, colour_of(orientation))


def _ring(mode: int, orientation: Quaternion, size: float) -> Part:
    angles = 2.0 * np.pi * np.arange(SIDES + 1) / SIDES
    around = np.stack([np.zeros_like(angles), np.cos(angles), np.sin(angles)], axis=1) * size
    inner, outer = INNER * around, OUTER * around
    corners = np.stack([inner[:-1], outer[:-1], inner[1:],
                        outer[:-1], outer[1:], inner[1:]], axis=1)
    colours = np.tile(colour_of(orientation), (SIDES, 6, 1))
    if mode != MOVE_PLANE:
        colours[::2, :, :3] *= SHADES[0]
        colours[1::2, :, :3] *= SHADES[1]
    return Part("triangles", {"position": corners.reshape(-1, 3).astype(np.float32),
                              "colour": colours.reshape(-1, 4).astype(np.uint8)},
                pose=Pose(orientation=orientation))


def unique(names: list[str]) -> list[str]:
    """Control names for feedback: names that a marker has more than once get a number."""
    found: dict[str, Any] = {}
    for name in names:
        number, free = 0, name
        while free in found:
            free = f"{name}_u{number}"
            number += 1
        found[free] = None
    return list(found)
