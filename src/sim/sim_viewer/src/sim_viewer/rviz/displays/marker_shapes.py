"""The shapes of each type of visualization_msgs/Marker: a table of functions that make parts."""

from collections.abc import Callable
from typing import Any

import numpy as np

from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.displays.point_style import evenly
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import arrows, finite, lines, points, shapes, strip, towards

ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST = 0, 1, 2, 3, 4, 5
CUBE_LIST, SPHERE_LIST, POINTS, TEXT, MESH, TRIANGLES = 6, 7, 8, 9, 10, 11
ORIGIN = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
SHAFT = 0.77  # of an arrow's length
HEAD_WIDTH = 2.0  # in shaft diameters


def marker_parts(marker: Any, most: int) -> list[Part]:
    """Parts relative to the marker's pose; at most `most` points of a list. Problem if rviz would
    not show the marker. Meshes are not drawn here."""
    draw = DRAWN.get(marker.type)
    if draw is None:
        raise Problem(f"Unknown marker type: {marker.type}")
    return draw(marker, scale_of(marker), most)


def scale_of(marker: Any) -> np.ndarray:
    """(3,) m; Problem if values are not finite."""
    try:
        return finite([marker.scale.x, marker.scale.y, marker.scale.z])
    except Problem:
        raise Problem("Contains invalid floating point values (nans or infs)") from None


def colour_of(color: Any) -> np.ndarray:
    """(4,) of 0 to 255."""
    return np.clip(np.nan_to_num([color.r, color.g, color.b, color.a]) * 255, 0, 255).round()


def _arrow(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
    """An arrow between two points, or along the x axis of the marker's pose."""
    if not len(marker.points):
        _solid(scale)
        length, head = SHAFT * scale[0], (1 - SHAFT) * scale[0]
        return arrows(ORIGIN, (length, scale[1]), (head, HEAD_WIDTH * scale[1]),
                      colour_of(marker.color))
    if len(marker.points) != 2:
        raise Problem("Number of points for an ARROW marker should be either 0 or 2.")
    first, last = points(marker.points)
    gap = (last - first)[None]
    length = float(np.linalg.norm(gap))
    head = min(scale[2] or (1 - SHAFT) * length, length)
    row = np.hstack([first[None], towards(gap)])
    return arrows(row, (length - head, scale[0]), (head, scale[1]), colour_of(marker.color))


def _one(shape: str) -> Callable[..., list[Part]]:
    def draw(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
        _solid(scale)
        return [shapes(shape, ORIGIN, scale, colour_of(marker.color))]
    return draw


def _many(shape: str) -> Callable[..., list[Part]]:
    def draw(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
        _solid(scale)
        chosen, colours = _listed(marker, most // 10)
        rows = np.hstack([chosen, np.tile(ORIGIN[:, 3:], (len(chosen), 1))])
        return [shapes(shape, rows, scale, colours)]
    return draw


def _solid(scale: np.ndarray) -> None:
    if not scale.all():
        raise Problem("Scale contains 0.0 in x, y or z.")


def _wide(scale: np.ndarray) -> float:
    if not scale[0]:
        raise Problem("Width LINE_LIST or LINE_STRIP is 0.0 (scale.x).")
    return abs(float(scale[0]))


def _line_strip(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
    return [strip(*_listed(marker, most), _wide(scale))]


def _line_list(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
    if len(marker.points) % 2:
        raise Problem("Number of points should be a multiple of 2 for LINE_LIST marker.")
    positions, colours = _listed(marker, len(marker.points))
    return [lines(positions[:2 * most], colours[:2 * most], _wide(scale))]


def _triangles(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
    if len(marker.points) % 3:
        raise Problem("Number of points should be a multiple of 3 for TRIANGLE_LIST marker.")
    positions, colours = _listed(marker, len(marker.points))
    count = len(positions)
    if len(marker.colors) == count // 3 and count:
        colours = np.repeat([colour_of(one) for one in marker.colors], 3, axis=0)
    return [Part("triangles", {"position": (positions * scale)[:3 * most].astype(np.float32),
                               "colour": colours[:3 * most].astype(np.uint8)})]


def _points(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
    if not scale[0] or not scale[1]:
        raise Problem("Width and/or height of POINTS marker is 0.0 (scale.x, scale.y).")
    positions, colours = _listed(marker, most)
    return [Part("points", {"position": positions.astype(np.float32),
                            "colour": colours.astype(np.uint8)},
                 {"size": abs(float(scale[0])), "unit": "m", "round": False})]


def _text(marker: Any, scale: np.ndarray, most: int) -> list[Part]:
    if not scale[2]:
        raise Problem("Text height is 0.0 (scale.z).")
    if not marker.text.strip():
        raise Problem("Text is empty.")
    return [Part("texts", fields={"texts": [
        {"text": marker.text[:1000], "position": [0.0, 0.0, 0.0], "height": float(scale[2]),
         "colour": colour_of(marker.color).tolist()}]})]


def _listed(marker: Any, most: int) -> tuple[np.ndarray, np.ndarray]:
    """At most `most` points (n, 3) m and colours (n, 4); Problem if there are none."""
    if not len(marker.points):
        raise Problem("Points should not be empty for specified marker type.")
    count = len(marker.points)
    which = evenly(count, max(most, 2))
    positions = points(marker.points)[which]
    if len(marker.colors) != count:
        return positions, np.tile(colour_of(marker.color), (len(positions), 1))
    return positions, np.array([colour_of(one) for one in marker.colors])[which]


DRAWN: dict[int, Callable[[Any, np.ndarray, int], list[Part]]] = {
    ARROW: _arrow, CUBE: _one("cube"), SPHERE: _one("sphere"), CYLINDER: _one("cylinder"),
    LINE_STRIP: _line_strip, LINE_LIST: _line_list, CUBE_LIST: _many("cube"),
    SPHERE_LIST: _many("sphere"), POINTS: _points, TEXT: _text, TRIANGLES: _triangles,
}
