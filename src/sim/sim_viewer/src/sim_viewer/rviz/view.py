"""What displays need from ROS while they draw: frames, files, parameters, the time."""

import time
from collections.abc import Hashable
from typing import Any

import rospy

from bullet_sim.description import SceneDescription, Visual
from bullet_sim.errors import SimulationError
from bullet_sim.formats.urdf.link import read_robot_visuals
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.rendering.scene_text import SceneContent
from sim_viewer.images import to_jpeg
from sim_viewer.page_scene import Meshes, page_scene
from sim_viewer.registry import Node, Refused
from sim_viewer.rviz.display_type import NoTransform, Problem
from sim_viewer.scene_sources import LIGHT, workspace_files
from sim_viewer.tools.clock import SharedClock
from sim_viewer.transforms import NoPose, Transforms


class RosView:
    """The View of display_type.py; `owner` is the display that asks."""

    def __init__(self, node: Node, owner: Hashable, fixed_frame: str):
        self.fixed_frame = fixed_frame.lstrip("/")
        self.most_points = 0
        self._owner = owner
        self._clock: SharedClock = node.shared(SharedClock)
        self._transforms: Transforms = node.shared(Transforms)
        self._meshes: Meshes = node.shared(Meshes)
        self._visuals: dict[str, tuple[Visual, ...]] = {}
        self._links: dict[str, Any] = {}
        self._files: dict[str, str] = {}

    @property
    def now(self) -> float:
        """ROS time, s."""
        return self._clock.now()

    @property
    def wall(self) -> float:
        """Time of a monotonic clock, s."""
        return time.monotonic()

    def frames(self) -> dict[str, str]:
        """All frames and their parents."""
        return self._transforms.frames()

    def pose(self, frame: str, stamp: int = 0) -> Pose:
        """A frame's pose in the fixed frame. NoTransform says why not, as rviz words it."""
        try:
            return self._transforms.pose(self.fixed_frame, frame, stamp)
        except NoPose as error:
            raise NoTransform(f"For frame [{frame}]: {self._reason(frame, error)}") from None

    def _reason(self, frame: str, error: NoPose) -> str:
        for name, words in ((self.fixed_frame, "Fixed Frame"), (frame, "Frame")):
            if not self._transforms.has(name):
                return f"{words} [{name}] does not exist"
        return f"No transform to fixed frame [{self.fixed_frame}].  TF error: [{error}]"

    def parameter(self, name: str) -> Any:
        """A parameter's value; None if it is not set or there is no master."""
        try:
            found = rospy.search_param(name)
            return rospy.get_param(found) if found else None
        except (OSError, KeyError, rospy.ROSException):
            return None

    def resolve(self, uri: str) -> str:
        """The file of a URI; Problem if there is none."""
        if uri not in self._files:
            try:
                self._files[uri] = str(workspace_files().resolve(uri))
            except SimulationError as error:
                raise Problem(f"Could not load [{uri}]: {error}") from None
        return self._files[uri]

    def jpeg(self, message: Any, width: int) -> bytes:
        """An image message as JPEG. Problem if it cannot be shown."""
        try:
            return to_jpeg(message, width)
        except Refused as error:
            raise Problem(str(error)) from None

    def robot(self, text: str) -> dict[str, tuple[Visual, ...]]:
        """Each link's visuals. FormatError if the text is not a URDF."""
        links = read_robot_visuals(text, workspace_files())[1]
        return {name: visuals for name, (_, visuals) in links.items()}

    def links(self, visuals: dict[str, tuple[Visual, ...]]) -> dict[str, Any]:
        """Ambient light, lights and links, as page_scene returns them."""
        if visuals != self._visuals:
            content = SceneContent(SceneDescription(), (LIGHT,), {
                ("", name): (IDENTITY, shown) for name, shown in visuals.items()})
            scene = page_scene(content, self._meshes, self._owner)
            self._links = {name: scene[name] for name in ("ambient", "lights", "links")}
            self._visuals = dict(visuals)
        return self._links

    def close(self) -> None:
        """Release the meshes."""
        if self._visuals:
            self._meshes.forget(self._owner)
