"""Displays without ROS: what one asks while it draws is made up."""

from __future__ import annotations

from sim_viewer.rviz.display_type import NoTransform, Problem
from sim_viewer.rviz.options import check_all
from sim_viewer.rviz.types import TYPES

from bullet_sim.pose import IDENTITY, Pose


class MadeUpView:
    """The fixed frame is map; `places` by frame; tf is as far as `known_until` s."""

    def __init__(self, most_points: int = 1_000_000) -> None:
        self.now = self.wall = 0.0
        self.most_points = most_points
        self.fixed_frame = "map"
        self.places: dict[str, Pose] = {"map": IDENTITY}
        self.parents: dict[str, str] = {}
        self.parameters: dict[str, str] = {}
        self.known_until = float("inf")

    def pose(self, frame: str, stamp: int = 0) -> Pose:
        if frame not in self.places or stamp > self.known_until * 1e9:
            raise NoTransform(f"For frame [{frame}]: Frame [{frame}] does not exist")
        return self.places[frame]

    def jpeg(self, message, width: int) -> bytes:
        if not message.data:
            raise Problem("the picture has no pixels")
        return bytes(message.data)

    def frames(self) -> dict[str, str]:
        return self.parents

    def parameter(self, name: str) -> str | None:
        return self.parameters.get(name)

    def resolve(self, uri: str) -> str:
        if "none" in uri:
            raise Problem(f"Could not load [{uri}]")
        return "/" + uri

    def robot(self, text: str) -> dict[str, tuple]:
        return dict.fromkeys(text.split(), ("visual",))

    def links(self, visuals: dict[str, tuple]) -> dict:
        return {"links": list(visuals)}


def drawer(name: str, **options):
    """A display of rviz's class with these options."""
    kind = TYPES[f"rviz/{name}"]
    return kind.make(check_all(kind.options, options))


def draw(name: str, message, pose: Pose = IDENTITY, view: MadeUpView | None = None, **options):
    """Parts and statuses of a display that got one message."""
    made = drawer(name, **options)
    made.take(message, pose, 0.0)
    return made.draw(view or MadeUpView()), made.statuses


def only(parts: list):
    (part,) = parts
    return part
