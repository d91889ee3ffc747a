"""A robot without a simulator: its robot_description, placed by tf."""

import time

import numpy as np
import rospkg
import rospy
import tf2_ros
import yaml
from tf2_msgs.msg import TFMessage

from bullet_sim.description import LightDescription, SceneDescription
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.urdf.visuals import RobotLinks, read_robot_visuals
from bullet_sim.pose import IDENTITY
from bullet_sim.rendering.scene_text import SceneContent
from sim_viewer.subscription import Subscription
from sim_viewer.tools import names

DESCRIPTION = "/robot_description"
POLL_PERIOD = 2.0  # s between reads of the parameter and of tf's tree
# An arbitrary light: neither the URDF nor tf describe one.
LIGHT = LightDescription("sun", type="directional", direction=(-0.5, 0.3, -1.0),
                         diffuse=(0.8, 0.8, 0.8, 1.0))


class RobotSource:
    """Poses are in the frame at the root of tf's tree; tf is subscribed to once they are wanted."""

    def __init__(self):
        self._buffer: tf2_ros.Buffer | None = None
        self._listeners: list[Subscription] = []
        self._text: str | None = None
        self._name = ""
        self._links: tuple[str, ...] = ()
        self._root = ""
        self._looked = -POLL_PERIOD

    def close(self) -> None:
        """Let tf go."""
        for listener in self._listeners:
            listener.unregister()
        self._buffer, self._listeners, self._text = None, [], None

    def scene(self, known: bool) -> SceneContent | None:
        """If there is another one than at the last call, or if that one is not `known`.

        FormatError of a description that cannot be read.
        """
        if known and time.monotonic() - self._looked < POLL_PERIOD:
            return None
        self._looked = time.monotonic()
        text = str(rospy.get_param(DESCRIPTION, ""))
        self._root = ""  # sought again
        if known and text == self._text:
            return None
        self._text = text
        return self._read(text)

    def poses(self) -> tuple[tuple[str, ...], np.ndarray] | None:
        """Names and (n, 7) of links that tf has."""
        if self._buffer is None:
            self._buffer = tf2_ros.Buffer()
            self._listeners = [Subscription(topic, TFMessage, self._take_transforms, static)
                               for topic, static in ((names.TF, False), (names.TF_STATIC, True))]
        self._root = self._root or self._find_root()
        found = {link: row for link in self._links if (row := self._row(link)) is not None}
        rows = np.array(list(found.values()), np.float32).reshape(-1, 7)
        return tuple(f"{self._name}::{link}" for link in found), rows

    def _take_transforms(self, message: TFMessage, static: bool) -> None:
        buffer = self._buffer
        if buffer is None:
            return  # closed meanwhile
        keep = buffer.set_transform_static if static else buffer.set_transform
        for transform in message.transforms:
            keep(transform, "tf")

    def _read(self, text: str) -> SceneContent:
        links: RobotLinks = {}
        if text:
            resources = Resources.from_environment(find_package=rospkg.RosPack().get_path)
            self._name, links = read_robot_visuals(text, resources)
        self._links = tuple(links)
        return SceneContent(SceneDescription(), (LIGHT,), {
            (self._name, link): shown for link, shown in links.items()})

    def _find_root(self) -> str:
        """Up tf's tree from the robot's first link."""
        # Empty trees are written as [] by tf.
        frames = yaml.safe_load(self._buffer.all_frames_as_yaml()) or {}
        root, seen = next(iter(self._links), ""), set()
        while root in frames and root not in seen:
            seen.add(root)
            root = str(frames[root]["parent"])
        return root

    def _row(self, link: str) -> list[float] | None:
        if link == self._root:
            return [*IDENTITY.position, *IDENTITY.orientation]
        try:
            found = self._buffer.lookup_transform(self._root, link, rospy.Time(0)).transform
        except (tf2_ros.TransformException, ValueError):
            return None
        place, turn = found.translation, found.rotation
        return [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]
