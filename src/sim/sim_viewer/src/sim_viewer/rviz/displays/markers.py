"""rviz/Marker and rviz/MarkerArray: added, changed, deleted, and gone after their lifetime."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bullet_sim.description import Material, Mesh, Visual
from bullet_sim.pose import IDENTITY, Pose
from sim_viewer.rviz.display_type import (
    ERROR,
    WARNING,
    DisplayType,
    Drawer,
    Problem,
    View,
)
from sim_viewer.rviz.displays.points import evenly
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import (
    arrows,
    finite,
    lines,
    moved,
    points,
    pose_of,
    shapes,
    strip,
    towards,
)
from sim_viewer.rviz.options import Option

ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST = 0, 1, 2, 3, 4, 5
CUBE_LIST, SPHERE_LIST, POINTS, TEXT, MESH, TRIANGLES = 6, 7, 8, 9, 10, 11
ORIGIN = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
SHAFT = 0.77  # of an arrow's length
HEAD_WIDTH = 2.0  # in shaft diameters
DELETE, DELETE_ALL = 2, 3
MOST_MARKERS = 20_000
MOST_STATUSES = 20
MOST_NAMESPACES = 100
JITTER = 1.0  # s that time may go back before a marker with a lifetime is gone
Key = tuple[str, int]  # namespace and id


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


@dataclass
class Shown:
    """One marker; `place` is its frame in the fixed frame, once that is known."""

    marker: Any
    begins: float  # s; -inf without a lifetime
    ends: float  # s; inf without a lifetime
    pose: Pose = IDENTITY
    parts: list[Part] = field(default_factory=list)
    visuals: tuple[Visual, ...] = ()  # of a mesh
    place: Pose | None = None
    problem: str = ""  # why there is nothing to be drawn
    lost: str = ""  # why its frame has no pose

    def build(self, view: View, most_points: int) -> None:
        """Make its parts or, for a mesh, its visuals."""
        try:
            self.pose = pose_of(self.marker.pose)
            if self.marker.type == MESH:
                scale = tuple(map(float, scale_of(self.marker)))
                path = view.resolve(self.marker.mesh_resource)
                self.visuals = (Visual("mesh", Mesh(path, scale), material=_material(self.marker)),)
            else:
                self.parts = marker_parts(self.marker, most_points)
        except Problem as problem:
            self.problem = str(problem)

    def put(self, view: View) -> bool:
        """Look up its frame if that is due; returns whether it has moved."""
        locked = self.marker.frame_locked
        if self.place is not None and not locked:
            return False
        header, before = self.marker.header, self.place
        try:
            self.place = view.pose(header.frame_id, 0 if locked else header.stamp.to_nsec())
            self.lost = ""
        except Problem as problem:
            self.lost = str(problem)
        return self.place != before


class Markers(Drawer):
    """All markers of one topic."""

    def __init__(self, options: dict[str, Any]):
        super().__init__(options)
        self._shown: dict[Key, Shown] = {}
        self._new: set[Key] = set()
        self._full = False

    def take(self, message: Any, pose: Pose | None, now: float) -> None:
        for marker in message.markers if hasattr(message, "markers") else [message]:
            self._take(marker, now)
        self.changed = True

    def _take(self, marker: Any, now: float) -> None:
        key = (marker.ns, marker.id)
        if marker.action == DELETE_ALL:
            self._shown.clear()
        elif marker.action == DELETE:
            self._shown.pop(key, None)
        elif key in self._shown or len(self._shown) < MOST_MARKERS:
            if marker.ns not in self.namespaces:
                self.namespaces = [*self.namespaces, marker.ns][:MOST_NAMESPACES]
            life = marker.lifetime.to_sec()
            times = (now, now + life) if life > 0 else (-np.inf, np.inf)
            self._shown[key] = Shown(marker, *times)
            self._new.add(key)
        else:
            self._full = True

    def place_anew(self) -> bool:
        """Each marker is placed anew, by its own frame and stamp."""
        for one in self._shown.values():
            one.place = None
        self.changed = True
        return True

    def draw(self, view: View) -> list[Part] | None:
        for key in [key for key, one in self._shown.items()
                    if not one.begins - JITTER <= view.now < one.ends]:
            del self._shown[key]
            self.changed = True
        new, self._new = self._new & set(self._shown), set()
        for key in new:
            self._shown[key].build(view, view.most_points // len(new))
        moved = [one.put(view) for one in self._shown.values()]
        wrong = [(key, one) for key, one in self._shown.items() if one.problem or one.lost]
        self.statuses = {f"{ns}/{number}": (ERROR, one.problem or one.lost)
                         for (ns, number), one in wrong[:MOST_STATUSES]}
        if self._full and len(self._shown) == MOST_MARKERS:
            self.statuses["Markers"] = WARNING, f"showing {MOST_MARKERS}: more are left out"
        if not self.changed and not any(moved):
            return None
        self.changed = False
        hidden = {name for name, wanted in self.options["Namespaces"].items() if not wanted}
        return _parts({key: one for key, one in self._shown.items()
                       if one.place is not None and key[0] not in hidden}, view)


def _parts(seen: dict[Key, Shown], view: View) -> list[Part]:
    """All shapes of a kind are in one part, and all meshes in another."""
    meshes = {f"{ns}/{number}": one for (ns, number), one in seen.items() if one.visuals}
    return merged(list(seen.values())) + [part for part, _ in mesh_parts([meshes], view)]


def merged(seen: list[Shown]) -> list[Part]:
    """The parts of markers without meshes; all shapes of a kind are in one part."""
    found: dict[str, list[tuple[np.ndarray, np.ndarray]]] = {}
    parts = []
    for one in seen:
        pose = one.place * one.pose
        for part in one.parts:
            if part.kind == "shapes":
                found.setdefault(part.fields["shape"], []).append(
                    (moved(part.arrays["rows"], pose), part.arrays["colour"]))
            else:
                parts.append(Part(part.kind, part.arrays, part.fields, pose * part.pose))
    for shape, tables in found.items():
        table = np.concatenate([rows for rows, _ in tables]).astype(np.float32)
        colours = np.concatenate([colours for _, colours in tables])
        parts.append(Part("shapes", {"rows": table, "colour": colours}, {"shape": shape}))
    return parts


def mesh_parts(groups: list[dict[str, Shown]], view: View) -> list[tuple[Part, int]]:
    """A part for each group that is not empty, and the group's number. Names must be unique."""
    visuals = {name: one.visuals for group in groups for name, one in group.items()}
    if not visuals:
        return []
    known = view.links(visuals)
    links = dict(zip(visuals, known["links"], strict=True))
    parts = []
    for number, group in enumerate(groups):
        poses = [one.place * one.pose for one in group.values()]
        rows = np.array([[*pose.position, *pose.orientation] for pose in poses], np.float32)
        if group:
            parts.append((Part("links", {"rows": rows},
                               {**known, "links": [links[name] for name in group]}), number))
    return parts


def _material(marker: Any) -> Material | None:
    """The marker's colour; None if the mesh's own materials are to be used."""
    colour = tuple(colour_of(marker.color) / 255)
    if marker.mesh_use_embedded_materials and not any(colour):
        return None
    return Material(ambient=colour, diffuse=colour)


OPTIONS = (Option("Namespaces", "namespaces", {}),)
MESSAGES = ("visualization_msgs/Marker", "visualization_msgs/MarkerArray")
MARKER = DisplayType("rviz/Marker", Markers, OPTIONS, MESSAGES, "/visualization_marker",
                     "Marker Topic", at_stamp=False, every=True, period=0.1)
ARRAY = DisplayType("rviz/MarkerArray", Markers, OPTIONS, MESSAGES, "/visualization_marker_array",
                    "Marker Topic", at_stamp=False, every=True, period=0.1)
