"""A pose's uncertainty: an ellipsoid for the position, a wedge on the floor for the direction."""

from typing import Any

import numpy as np

from bullet_sim.pose import normalised
from sim_viewer.rviz.colours import rgba
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import Z_TO_X, finite, multiplied, shapes, turned
from sim_viewer.rviz.options import Option

WIDEST = 1.4  # rad, half of a wedge
FLAT = 0.005  # m
ABOUT = "Covariance/Position", "Covariance/Orientation"
OPTIONS = (
    Option("Covariance/Value", "switch", True),
    *(option for name, color, alpha in ((ABOUT[0], "204; 51; 204", 0.3),
                                        (ABOUT[1], "255; 255; 127", 0.5))
      for option in (Option(f"{name}/Value", "switch", True),
                     Option(f"{name}/Color", "color", color),
                     Option(f"{name}/Alpha", "number", alpha, high=1),
                     Option(f"{name}/Scale", "number", 1.0))),
    Option("Covariance/Orientation/Offset", "number", 1.0))


def ellipsoid(row: np.ndarray, covariance: Any, options: dict[str, Any]) -> list[Part]:
    """One standard deviation around a pose (7,), from a (36,) covariance in the same frame.

    Problem if the covariance has values that are not finite.
    """
    if not options["Covariance/Value"]:
        return []
    matrix = finite(covariance).reshape(6, 6)
    parts = []
    if options["Covariance/Position/Value"]:
        values, vectors = np.linalg.eigh(matrix[:3, :3])
        vectors[:, 0] *= np.linalg.det(vectors)  # a rotation, no mirror
        place = np.array([[*row[:3], *_quaternion(vectors)]])
        scale = 2 * options["Covariance/Position/Scale"] * np.sqrt(np.maximum(values, 1e-8))
        parts.append(shapes("sphere", place, scale, _colour(options, ABOUT[0])))
    if options["Covariance/Orientation/Value"]:
        angle = np.sqrt(max(matrix[5, 5], 0.0)) * options["Covariance/Orientation/Scale"]
        length = options["Covariance/Orientation/Offset"]
        width = 2 * length * np.tan(min(angle, WIDEST))
        parts.append(_wedge(row[None], length, width, _colour(options, ABOUT[1])))
    return parts


def _wedge(rows: np.ndarray, length: float, width: float, colour: tuple) -> Part:
    """A flat cone with its tip at the pose, that opens along x."""
    middle = rows[:, :3] + turned(rows[:, 3:], np.array([[length / 2, 0.0, 0.0]]))
    back = multiplied(multiplied(rows[:, 3:], np.array([0.0, 0.0, 1.0, 0.0])), Z_TO_X)
    # Of the cone's own axes, x lies upright then and y across.
    return shapes("cone", np.hstack([middle, back]), [FLAT, width, length], colour)


def _colour(options: dict[str, Any], name: str) -> tuple:
    return rgba(options, f"{name}/Color", f"{name}/Alpha")


def _quaternion(matrix: np.ndarray) -> tuple[float, ...]:
    """x, y, z, w of a rotation: the eigenvector of Bar-Itzhack's symmetric matrix."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    table = np.array([[a - e - i, b + d, c + g, h - f], [b + d, e - a - i, f + h, c - g],
                      [c + g, f + h, i - a - e, d - b], [h - f, c - g, d - b, a + e + i]])
    return normalised(np.linalg.eigh(table)[1][:, -1])
