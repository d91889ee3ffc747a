"""rviz/Marker and rviz/MarkerArray: added, changed, deleted, and gone after their lifetime."""

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
from sim_viewer.rviz.displays.marker_shapes import MESH, colour_of, marker_parts, scale_of
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import moved, pose_of
from sim_viewer.rviz.options import Option

DELETE, DELETE_ALL = 2, 3
MOST_MARKERS = 20_000
MOST_STATUSES = 20
MOST_NAMESPACES = 100
JITTER = 1.0  # s that time may go back before a marker with a lifetime is gone
Key = tuple[str, int]  # namespace and id


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
