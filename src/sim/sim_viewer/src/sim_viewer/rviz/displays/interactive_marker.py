"""One interactive marker: its pose, its controls, and the shapes of those that have no markers.

Sizes and colours of those shapes are rviz's: arrows for moving along an axis, a ring for rotating
or moving in a plane, text for a menu.
"""

import functools
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bullet_sim.pose import IDENTITY, Pose, Quaternion
from sim_viewer.rviz.display_type import Problem, View
from sim_viewer.rviz.displays.markers import Shown
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import arrows, axes, finite, multiplied, points, turned

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
LARGEST = 1e6  # m, sizes and places
MOST_CONTROLS = 100  # of a marker
MOST_MARKERS = 200  # of a control
MOST_ENTRIES = 200  # of a menu
TITLE = ""  # name of the controls that show its axes and its description
FEEDBACK = 0  # type of a menu entry; the other types would start programs on this machine
AXIS_WIDTH = 0.05  # in units of the marker's size


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


@dataclass
class Control:
    """One control of a marker; `shown` is in the control's own frame."""

    name: str
    mode: int  # of visualization_msgs/InteractiveMarkerControl
    facing: int  # its orientation_mode
    orientation: Quaternion  # its x axis is that of the motion
    independent: bool = False  # whether its markers do not turn to the viewer with the axis
    text: str = ""
    shown: list[Shown] = field(default_factory=list)
    option: str = ""  # of the display, which shows it

    def as_json(self) -> dict[str, Any]:
        """The control's data for the page."""
        return {"name": self.name, "mode": self.mode, "facing": self.facing, "text": self.text,
                "orientation": self.orientation, "independent": self.independent}


class InteractiveMarker:
    """`message` is visualization_msgs/InteractiveMarker; `place` is its header's frame in the fixed
    frame, once that is known."""

    def __init__(self, message: Any):
        self.message, self.header = message, message.header
        self.controls: list[Control] = []
        self.place: Pose | None = None
        self.lost = ""  # why it, or one of its markers, has no pose
        self.problems: list[str] = []
        self.built = False
        self._first = IDENTITY  # the pose of its message
        self._moved: Pose | None = None  # a pose that was set since

    @property
    def pose(self) -> Pose:
        """The marker's pose in its header's frame."""
        return self._moved or self._first

    @property
    def size(self) -> int:
        """How many markers there are to be drawn."""
        return sum(max(1, min(len(one.markers), MOST_MARKERS))
                   for one in self._given)

    @functools.cached_property
    def control_names(self) -> list[str]:
        """Unique names of its controls for feedback, also before they are built."""
        return [TITLE, *unique([one.name[:LONGEST_TEXT] for one in self._given])]

    @property
    def _given(self) -> list[Any]:
        return self.message.controls[:MOST_CONTROLS]

    def move(self, pose: Pose, header: Any = None) -> None:
        """Set its pose, and another frame if there is a `header`."""
        self._moved = pose
        if header is not None:
            self.header, self.place = header, None

    def build(self, view: View, most_points: int) -> None:
        """Make its controls and their parts."""
        self.built = True
        try:
            self._first = unit_pose(self.message.pose)
            scale = _size(self.message.scale)
        except Problem as problem:
            self.problems.append(str(problem))
            return
        self._build_controls(scale, view, most_points)
        self.controls += _extras(self.message, scale)

    def _build_controls(self, scale: float, view: View, most_points: int) -> None:
        given = self._given
        if len(given) < len(self.message.controls):
            self.problems.append(f"showing {MOST_CONTROLS} of {len(self.message.controls)} "
                                 "controls")
        for name, one in zip(self.control_names[1:], given, strict=True):
            try:
                made = _control(name, one, scale, view, most_points // len(given))
            except Problem as problem:
                self.problems.append(f"{name}: {problem}")
                continue
            self.controls.append(made)
            self.problems += [f"{name}: {shown.problem}" for shown in made.shown if shown.problem]

    def put(self, view: View) -> bool:
        """Look up its frame if that is due; returns whether it has moved."""
        locked = not self.header.stamp.to_nsec()
        if self.place is not None and not locked and not self.lost:
            return False
        before = self.place
        try:
            self.place = view.pose(self.header.frame_id, self.header.stamp.to_nsec())
            for control in self.controls:
                self._put_markers(control, view)
            self.lost = ""
        except Problem as problem:
            self.lost = str(problem)
        return self.place != before

    def _put_markers(self, control: Control, view: View) -> None:
        """Markers with a frame of their own are placed once, and keep that pose to the control."""
        turn = IDENTITY.orientation if control.facing == FIXED else self._first.orientation
        frame = self.place * Pose(self._first.position, turn)
        for one in control.shown:
            if one.place is None:
                header = one.marker.header
                one.place = frame.inverse() * view.pose(header.frame_id, header.stamp.to_nsec())

    def as_json(self, key: str) -> dict[str, Any]:
        """For the page, which does the dragging; `key` is unique."""
        return {"key": key, "place": [*self.place.position, *self.place.orientation],
                "pose": [*self.pose.position, *self.pose.orientation],
                "controls": [one.as_json() for one in self.controls],
                "menu": bool(self.message.menu_entries)}

    def menu(self) -> list[dict[str, Any]]:
        """The entries of its menu, for the page."""
        return [{"id": one.id, "parent": one.parent_id, "title": one.title[:LONGEST_TEXT],
                 "works": one.command_type == FEEDBACK}
                for one in self.message.menu_entries[:MOST_ENTRIES]]


def unit(message: Any) -> Quaternion:
    """x, y, z, w of a geometry_msgs/Quaternion, normalised; all zeros mean no rotation.

    Problem if values are not finite.
    """
    values = finite([message.x, message.y, message.z, message.w])
    largest = np.abs(values).max()
    if not largest:
        return IDENTITY.orientation
    values = values / largest  # else squares of very large or small values overflow or vanish
    return tuple(map(float, values / np.linalg.norm(values)))


def unit_pose(message: Any) -> Pose:
    """A pose from a geometry_msgs/Pose; Problem if values are not finite, or too far away."""
    position = points([message.position])[0]
    if np.abs(position).max() > LARGEST:
        raise Problem(f"farther than {LARGEST:g} m")
    return Pose(tuple(map(float, position)), unit(message.orientation))


def _size(scale: float) -> float:
    """A marker's size, m; 1 if it is not set. Problem if it is invalid."""
    found = float(finite([scale])[0]) or 1.0
    if not 0.0 < found <= LARGEST:
        raise Problem(f"The scale is {found:g}, which is not between 0 and {LARGEST:g} m")
    return found


def _control(name: str, message: Any, scale: float, view: View, most_points: int) -> Control:
    mode, facing = message.interaction_mode, message.orientation_mode
    if mode >= MODES:
        raise Problem(f"Unknown interaction mode: {mode}")
    if facing > VIEW_FACING:
        raise Problem(f"Unknown orientation mode: {facing}")
    made = Control(name, mode, facing, unit(message.orientation),
                   bool(message.independent_marker_orientation), message.description[:LONGEST_TEXT])
    for marker in message.markers[:MOST_MARKERS]:
        made.shown.append(_shown(marker, view, most_points // len(message.markers)))
    if not message.markers:
        parts = handle_parts(mode, made.orientation, scale, made.text)
        made.shown = [_still(parts)]
        if parts and parts[0].kind == "texts":
            made.facing = VIEW_FACING
    return made


def _shown(marker: Any, view: View, most_points: int) -> Shown:
    """A marker of a control; without a frame_id it is in the control's frame."""
    made = Shown(marker, -np.inf, np.inf)
    try:
        for axis, value in zip("xyzw", unit(marker.pose.orientation), strict=True):
            setattr(marker.pose.orientation, axis, value)
        for axis in "xyz":  # unset ones become 1, as in rviz
            setattr(marker.scale, axis, getattr(marker.scale, axis) or 1.0)
        made.build(view, most_points)
    except Problem as problem:
        made.problem = str(problem)
    if not marker.header.frame_id or made.problem:
        made.place = IDENTITY
    return made


def _still(parts: list[Any]) -> Shown:
    return Shown(None, -np.inf, np.inf, parts=parts, place=IDENTITY)


def _extras(message: Any, scale: float) -> list[Control]:
    """The marker's axes and description, which options of the display show."""
    cross = axes(np.array([[0.0] * 6 + [1.0]]), scale, AXIS_WIDTH * scale)
    made = [Control(TITLE, NONE, INHERIT, IDENTITY.orientation, shown=[_still(cross)],
                    option="Show Axes")]
    if message.description.strip():
        title = words(message.description, TITLE_ABOVE * scale, TITLE_HEIGHT * scale)
        made.append(Control(TITLE, NONE, VIEW_FACING, IDENTITY.orientation, shown=[_still([title])],
                            option="Show Descriptions"))
    return made
