"""What the 3D view shows: the simulator's scene, or else robot_description placed by tf."""

import contextlib
import struct
import time

import numpy as np
import rospkg
import rospy
from std_msgs.msg import String

from bullet_sim.description import LightDescription, SceneDescription
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.urdf.link import RobotLinks, read_robot_visuals
from bullet_sim.pose import IDENTITY
from bullet_sim.rendering.scene_text import SceneContent, scene_from_text
from sim_viewer.subscription import Subscription
from sim_viewer.tools import names
from sim_viewer.tools.master import MasterView, simulator_name
from sim_viewer.transforms import NoPose, Transforms

POSE = np.dtype("<f8")
_COUNT = struct.Struct("<I")
DESCRIPTION = "/robot_description"
POLL_PERIOD = 2.0  # s between look-ups of the simulator, or of the parameter and tf's tree
# An arbitrary light: neither the URDF nor tf describe one.
LIGHT = LightDescription("sun", type="directional", direction=(-0.5, 0.3, -1.0),
                         diffuse=(0.8, 0.8, 0.8, 1.0))


class SimulatorSource:
    """Link states come faster than they are shown, so only the last message is decoded."""

    def __init__(self, master: MasterView):
        self._master = master
        self._name = ""
        self._looked = 0.0
        self._subscribers: list[Subscription | rospy.Subscriber] = []
        self._text: str | None = None
        self._read: str | None = None  # which text was read last
        self._states: bytes | None = None
        self._names: tuple[str, ...] = ()
        self._names_bytes = b""

    def open(self) -> None:
        """Subscribe; to be repeated, since the simulator may start later, under another name."""
        if self._name and time.monotonic() - self._looked < POLL_PERIOD:
            return
        self._looked = time.monotonic()
        name = simulator_name(self._master.state())
        if name == self._name:
            return
        self.close()
        self._name = name
        self._subscribers = [
            Subscription(name + names.SCENE, String, self._take_scene),
            rospy.Subscriber(name + names.LINK_STATES, rospy.AnyMsg, self._take_states,
                             queue_size=1),
        ]

    def close(self) -> None:
        """Unsubscribe."""
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._subscribers, self._name = [], ""
        self.forget()

    def forget(self) -> None:
        """Forget the last simulator's state, as it has ended."""
        if not self.present():
            self._text = self._states = None

    def present(self) -> bool:
        """Whether a simulator is there."""
        return any(one.get_num_connections() for one in self._subscribers)

    def scene(self, known: bool) -> SceneContent | None:
        """The scene, if it has changed since the last call or the caller does not know that one.

        FormatError if the text is not a scene.
        """
        text = self._text
        if text is None or (known and text is self._read):
            return None
        self._read = text
        return scene_from_text(text)

    def poses(self) -> tuple[tuple[str, ...], np.ndarray] | None:
        """Names and poses (n, 7) of links, if there is a new message."""
        states, self._states = self._states, None
        if states is None:
            return None
        if not self._names_bytes or not states.startswith(self._names_bytes):
            self._names, end = _read_names(states)
            self._names_bytes = states[:end]
        count = len(self._names)
        rows = np.frombuffer(states, POSE, 7 * count, len(self._names_bytes) + _COUNT.size)
        return self._names, rows.reshape(count, 7).astype(np.float32)

    def _take_scene(self, msg: String) -> None:
        self._text = msg.data

    def _take_states(self, msg: rospy.AnyMsg) -> None:
        self._states = msg._buff


def _read_names(states: bytes) -> tuple[tuple[str, ...], int]:
    """The names that a serialized gazebo_msgs/LinkStates begins with, and where they end.

    string[] name is followed by geometry_msgs/Pose[] pose: their number, then seven float64 each.
    """
    count, at, found = _COUNT.unpack_from(states)[0], _COUNT.size, []
    for _ in range(count):
        length = _COUNT.unpack_from(states, at)[0]
        at += _COUNT.size
        found.append(states[at:at + length].decode("utf-8", "replace"))
        at += length
    return tuple(found), at


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
