"""rviz/Marker and rviz/MarkerArray: added, changed, deleted, and gone after their lifetime."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bullet_sim.description import Material, Mesh, Visual
from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import ERROR, DisplayType, Drawer, Problem, View
from sim_viewer.rviz.displays.marker_shapes import MESH, colour_of, marker_parts, scale_of
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import moved, pose_of
from sim_viewer.rviz.options import Option

DELETE, DELETE_ALL = 2, 3
MOST_MARKERS = 20_000
MOST_STATUSES = 20
Key = tuple[str, int]  # namespace and id


@dataclass
class Shown:
    """One marker; `place` is its frame in the fixed frame, once that is known."""

    marker: Any
    ends: float  # s; infinite without a lifetime
    pose: Pose
    parts: list[Part] = field(default_factory=list)
    place: Pose | None = None


class Markers(Drawer):
    """All markers of one topic."""

    def __init__(self, options: dict[str, Any]):
        super().__init__(options)
        self._shown: dict[Key, Shown] = {}
        self._problems: dict[Key, str] = {}
        self._new: set[Key] = set()

    def take(self, message: Any, pose: Pose | None, now: float) -> None:
        for marker in getattr(message, "markers", None) or [message]:
            self._take(marker, now)
        self.changed = True

    def _take(self, marker: Any, now: float) -> None:
        key = (marker.ns, marker.id)
        if marker.action == DELETE_ALL:
            self._shown.clear()
            self._problems.clear()
        elif marker.action == DELETE:
            self._forget(key)
        elif key in self._shown or len(self._shown) < MOST_MARKERS:
            self._forget(key)
            life = marker.lifetime.to_sec()
            try:
                self._shown[key] = Shown(marker, now + life if life > 0 else np.inf,
                                         pose_of(marker.pose))
                self._new.add(key)
            except Problem:
                self._problems[key] = "Contains invalid floating point values or quaternions"

    def _forget(self, key: Key) -> None:
        self._shown.pop(key, None)
        self._problems.pop(key, None)

    def draw(self, view: View) -> list[Part] | None:
        for key in [key for key, one in self._shown.items() if one.ends <= view.now]:
            self._forget(key)
            self.changed = True
        new, self._new = self._new, set()
        for key in new & set(self._shown):
            self._build(key, view.most_points // max(len(new), 1))
        for key, one in self._shown.items():
            self._place(key, one, view)
        self.statuses = {f"{ns}/{number}": (ERROR, text) for (ns, number), text in
                         list(self._problems.items())[:MOST_STATUSES]}
        if not self.changed:
            return None
        self.changed = False
        return self._parts(view)

    def _build(self, key: Key, most: int) -> None:
        one = self._shown[key]
        try:
            if one.marker.type == MESH:
                scale_of(one.marker)
            else:
                one.parts = marker_parts(one.marker, most)
        except Problem as problem:
            self._problems[key] = str(problem)

    def _place(self, key: Key, one: Shown, view: View) -> None:
        if one.place is not None and not one.marker.frame_locked:
            return
        header = one.marker.header
        locked = one.marker.frame_locked
        try:
            place = view.pose(header.frame_id, 0.0 if locked else header.stamp.to_sec())
        except Problem as problem:
            self._problems[key] = str(problem)
            return
        if one.place is None:
            self._problems.pop(key, None) if one.parts or one.marker.type == MESH else None
        self.changed |= place != one.place
        one.place = place

    def _parts(self, view: View) -> list[Part]:
        hidden = {name for name, wanted in self.options["Namespaces"].items() if not wanted}
        seen = {key: one for key, one in self._shown.items()
                if one.place is not None and key[0] not in hidden}
        merged: dict[str, list[tuple[np.ndarray, np.ndarray]]] = {}
        parts = []
        for one in seen.values():
            pose = one.place * one.pose
            for part in one.parts:
                if part.kind == "shapes":
                    merged.setdefault(part.fields["shape"], []).append(
                        (moved(part.arrays["rows"], pose), part.arrays["colour"]))
                else:
                    parts.append(Part(part.kind, part.arrays, part.fields, pose))
        parts += [Part("shapes", {"rows": np.concatenate([rows for rows, _ in found]
                                                         ).astype(np.float32),
                                  "colour": np.concatenate([colours for _, colours in found])},
                       {"shape": shape}) for shape, found in merged.items()]
        return parts + self._meshes(seen, view)

    def _meshes(self, seen: dict[Key, Shown], view: View) -> list[Part]:
        visuals, rows = {}, []
        for (ns, number), one in seen.items():
            if one.marker.type != MESH:
                continue
            try:
                path = view.resolve(one.marker.mesh_resource)
            except Problem as problem:
                self._problems[ns, number] = str(problem)
                continue
            visuals[f"{ns}/{number}"] = (Visual("mesh", Mesh(
                path, tuple(map(float, scale_of(one.marker)))), material=_material(one.marker)),)
            pose = one.place * one.pose
            rows.append([*pose.position, *pose.orientation])
        if not visuals:
            return []
        return [Part("links", {"rows": np.array(rows, np.float32)}, view.links(visuals))]


def _material(marker: Any) -> Material | None:
    """The marker's colour, but where the mesh's own are asked for."""
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
