"""A type of display: its name, messages, options and how it is drawn. Without ROS."""

import abc
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from bullet_sim.description import Visual
from bullet_sim.pose import Pose
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.options import Option

OK, WARNING, ERROR = "ok", "warning", "error"
Statuses = dict[str, tuple[str, str]]  # name -> level and text, as rviz lists them below a display


class Problem(ValueError):
    """A message that cannot be shown; the text says why, as rviz words it."""


class NoTransform(Problem):
    """There is no transform from a frame to the fixed frame, or not at that time."""


class View(Protocol):
    """What a display may request while it draws."""

    now: float  # s, ROS time
    wall: float  # s, monotonic clock
    most_points: int  # that the page can draw at once
    fixed_frame: str

    def pose(self, frame: str, stamp: int = 0) -> Pose:
        """A frame's pose in the fixed frame at a time in ns, 0: the newest. Raises NoTransform."""

    def links(self, visuals: dict[str, tuple[Visual, ...]]) -> dict[str, Any]:
        """The fields of a part of kind `links`, with meshes that the page can load."""

    def robot(self, text: str) -> dict[str, tuple[Visual, ...]]:
        """The visuals of each link of a URDF. FormatError if the text is not a URDF."""

    def resolve(self, uri: str) -> str:
        """The file of a `package://...` or `file://...` URI. Problem if there is none."""

    def jpeg(self, message: Any, width: int) -> bytes:
        """An image message as JPEG, at most `width` px wide. Problem if it cannot be shown."""

    def frames(self) -> dict[str, str]:
        """All frames of tf and their parents; a root's is empty."""

    def parameter(self, name: str) -> Any:
        """The value of a ROS parameter; None if it is not set."""


class Drawer(abc.ABC):
    """One display's state. Called in one thread at a time."""

    statuses: Statuses
    namespaces: list[str] = []  # of markers
    most_kept = 500  # how many of the newest messages there is room for

    def __init__(self, options: dict[str, Any]):
        self.options = options
        self.statuses = {}
        self.changed = False  # since the last drawing

    def restyle(self, options: dict[str, Any]) -> None:
        """Use other options from now on."""
        self.options, self.changed = options, True

    def take(self, message: Any, pose: Pose | None, now: float) -> None:  # noqa: B027 (TF has none)
        """Take a message; `pose` is that of its frame at its stamp, if the type waits for that.

        Problem if it cannot be shown.
        """

    def place_anew(self) -> bool:
        """The fixed frame has changed or time was reset. Returns whether the drawer places its
        contents anew by itself, without receiving its messages again."""
        return False

    @abc.abstractmethod
    def draw(self, view: View) -> list[Part] | None:
        """All parts, or None if they have not changed. Problem if they cannot be drawn."""


@dataclass(frozen=True)
class DisplayType:
    """The properties of a display type `rviz/...`."""

    name: str
    make: Callable[[dict[str, Any]], Drawer]
    options: tuple[Option, ...] = ()
    messages: tuple[str, ...] = ()  # types that its topic may have; none: it has no topic
    topic: str = ""  # the default
    topic_key: str = "Topic"  # in a .rviz file
    at_stamp: bool = True  # whether a message waits for its frame's pose at its stamp
    every: bool = False  # whether each message counts, not only the newest
    beside: str = ""  # the type of a second topic: a map's changes, a camera's CameraInfo
    beside_topic: Callable[[str], str] = str  # its name, from the first one's
    most_bytes: int = 16 << 20  # of a message: Python's objects are twenty times as large
    period: float = 0.0  # s between two drawings without a message; 0: not needed

    def as_json(self) -> dict[str, Any]:
        """The type's data for the page."""
        return {"class": self.name, "messages": self.messages, "topic": self.topic,
                "options": [option.as_json() for option in self.options]}


class Simple(Drawer):
    """Draws messages one by one with a function of message, options, most points and pose."""

    def __init__(self, options: dict[str, Any], draw: Callable[..., list[Part]]):
        super().__init__(options)
        self._draw = draw
        self._kept: list[tuple[float, Pose, Any]] = []  # received at, frame's pose, message

    def take(self, message: Any, pose: Pose | None, now: float) -> None:
        self._kept.append((now, pose, message))
        self.changed = True

    def draw(self, view: View) -> list[Part] | None:
        keep = int(self.options.get("Buffer Length", self.options.get("History Length", 1)))
        decay = self.options.get("Decay Time", 0.0)
        if decay:
            fresh = [one for one in self._kept if view.now - decay < one[0] <= view.now]
        else:
            fresh = self._kept[-keep:]
        wanted, fresh = len(fresh), fresh[-self.most_kept:]
        if not self.changed and len(fresh) == len(self._kept):
            return None
        self._kept, self.changed = fresh, False
        parts = []
        for _, pose, message in fresh:
            most = view.most_points // len(fresh)
            drawn, statuses = self._draw(message, self.options, most, pose)
            self.statuses = statuses
            for part in drawn:
                part.pose = pose * part.pose
            parts += drawn
        if len(fresh) < wanted:
            self.statuses = {**self.statuses, "Messages": (
                WARNING, f"showing the last {len(fresh)}: there is no room for more")}
        return parts


def simple(draw: Callable[..., tuple[list[Part], Statuses]]) -> Callable[[dict], Simple]:
    """For DisplayType.make: `draw(message, options, most_points, pose)` returns parts in the
    message's frame, and statuses; `pose` is that frame's in the fixed frame."""
    return lambda options: Simple(options, draw)
