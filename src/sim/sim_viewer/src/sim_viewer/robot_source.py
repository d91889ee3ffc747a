"""A robot without a simulator: its robot_description, placed by tf."""

import contextlib
import time

import numpy as np
import rospkg
import rospy

from bullet_sim.description import LightDescription, SceneDescription
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.urdf.visuals import RobotLinks, read_robot_visuals
from bullet_sim.pose import IDENTITY
from bullet_sim.rendering.scene_text import SceneContent
from sim_viewer.transforms import NoPose, Transforms

DESCRIPTION = "/robot_description"
POLL_PERIOD = 2.0  # s between reads of the parameter and of tf's tree
# An arbitrary light: neither the URDF nor tf describe one.
LIGHT = LightDescription("sun", type="directional", direction=(-0.5, 0.3, -1.0),
                         diffuse=(0.8, 0.8, 0.8, 1.0))


def workspace_files() -> Resources:
    """Resolves `package://` and similar URIs in this workspace."""
    return Resources.from_environment(find_package=rospkg.RosPack().get_path)


class RobotSource:
    """Poses are in the root frame of tf's tree; tf is subscribed to at the first `poses`."""

    def __init__(self, transforms: Transforms):
        self._transforms = transforms
        self._held: contextlib.ExitStack | None = None
        self._text: str | None = None
        self._name = ""
        self._links: tuple[str, ...] = ()
        self._root = ""
        self._looked = -POLL_PERIOD

    def close(self) -> None:
        """Unsubscribe from tf."""
        if self._held is not None:
            self._held.close()
        self._held, self._text = None, None

    def scene(self, known: bool) -> SceneContent | None:
        """The scene, if it has changed since the last call or the caller does not know that one.

        FormatError if the description cannot be read.
        """
        if known and time.monotonic() - self._looked < POLL_PERIOD:
            return None
        self._looked = time.monotonic()
        text = str(rospy.get_param(DESCRIPTION, ""))
        self._root = ""  # to be searched for again
        if known and text == self._text:
            return None
        self._text = text
        return self._read(text)

    def poses(self) -> tuple[tuple[str, ...], np.ndarray] | None:
        """Names and poses (n, 7), x, y, z in m and the quaternion, of links that tf has."""
        if self._held is None:
            self._held = contextlib.ExitStack()
            self._held.enter_context(self._transforms.held())
        self._root = self._root or self._find_root()
        found = {link: row for link in self._links if (row := self._row(link)) is not None}
        rows = np.array(list(found.values()), np.float32).reshape(-1, 7)
        return tuple(f"{self._name}::{link}" for link in found), rows

    def _read(self, text: str) -> SceneContent:
        links: RobotLinks = {}
        if text:
            self._name, links = read_robot_visuals(text, workspace_files())
        self._links = tuple(links)
        return SceneContent(SceneDescription(), (LIGHT,), {
            (self._name, link): shown for link, shown in links.items()})

    def _find_root(self) -> str:
        """The root of tf's tree above the robot's first link."""
        frames = self._transforms.frames()
        root, seen = next(iter(self._links), ""), set()
        while frames.get(root) and root not in seen:
            seen.add(root)
            root = frames[root]
        return root

    def _row(self, link: str) -> list[float] | None:
        if link == self._root:
            return [*IDENTITY.position, *IDENTITY.orientation]
        try:
            pose = self._transforms.pose(self._root, link)
        except NoPose:
            return None
        return [*pose.position, *pose.orientation]
