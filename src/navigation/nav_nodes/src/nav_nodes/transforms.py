"""Looks up transforms by tf2, and logs one line on which one is missing or late."""

from __future__ import annotations

import re
import threading
import time
from dataclasses import dataclass

import numpy as np
import rospy
import tf2_py
import tf2_ros
from geometry_msgs.msg import Transform, TransformStamped

from nav_nodes.messages import yaw_of
from nav_nodes.missing_data import MissingData

# One frame's entry; a YAML parser takes 5 ms for a robot's, and is needed some 50 times a second.
FRAME = re.compile(r"^(\S+): ?\n  parent: '(.*)'\n(?:  .*\n)*?  most_recent_transform: (.*)\n",
                   re.MULTILINE)
TOGETHER = 0.25  # s; localisation that ends this soon after odometry is not to blame


@dataclass(frozen=True)
class TfLink:
    """The transform from `parent` to `child`; `newest`: its stamp, s; 0: a static one.

    None if there never was one.
    """

    parent: str
    child: str
    newest: float | None


def known_links(buffer: tf2_py.BufferCore) -> dict[str, TfLink]:
    """Links by the child's name."""
    return {child: TfLink(parent, child, float(newest))
            for child, parent, newest in FRAME.findall(buffer.all_frames_as_yaml())}


def weakest(links: dict[str, TfLink], parent: str, child: str,
            chain: tuple[str, ...] = ()) -> TfLink:
    """The link to blame if the transform from `parent` to `child` is not available.

    A missing one, else the oldest, or one farther down that ended with it. `chain`: frames' names,
    each of which should be known in the previous one, such as ("map", "odom", "base_link").
    """
    above, below = _ancestors(links, parent), _ancestors(links, child)
    shared = next((frame for frame in below if frame in above), None)
    if shared is None:
        if parent in chain[1:] and chain[chain.index(parent) - 1] in below:  # the chain is bypassed
            return TfLink(chain[chain.index(parent) - 1], parent, None)
        return _missing(below[-1], parent, child, chain)
    between = [links[frame] for branch in (below, above)
               for frame in branch[:branch.index(shared)]]
    moving = [link for link in between if link.newest]
    if not moving:
        return TfLink(parent, child, 0.0)
    oldest = min(link.newest for link in moving)
    return next(link for link in moving if link.newest < oldest + TOGETHER)


def _missing(root: str, parent: str, child: str, chain: tuple[str, ...]) -> TfLink:
    """The missing link above `root`, the topmost known ancestor of `child`.

    A frame outside the chain counts as part of the robot, whose frame is the chain's last.
    """
    named = root if root in chain[1:] else child
    if named in chain[1:]:
        parent = chain[chain.index(named) - 1]
    elif chain and root != chain[0]:
        parent = chain[-1]
    return TfLink(parent, root, None)


def _ancestors(links: dict[str, TfLink], frame: str) -> list[str]:
    """The frame itself, then its ancestors."""
    found = [frame]
    while found[-1] in links and links[found[-1]].parent not in found:
        found.append(links[found[-1]].parent)
    return found


NEWEST = rospy.Time(0)
POLL = 0.01  # s of wall time
LATE = 0.5   # s; older transforms are late, whatever stamp was requested
ODD = 3.0    # s for which messages may have odd stamps before that is logged
FAR = 2.0e9  # s from now; tf2 aborts the process if it subtracts stamps 68 years apart


class Transforms:
    """One tf2 buffer and listener per node; a lookup that fails logs a line and returns None.

    Waits in wall time, as the simulated clock may be paused.
    """

    def __init__(self, missing_data: MissingData, chain: tuple[str, ...] = (),
                 cache_s: float = 30.0) -> None:
        """`chain`: frames, each of which should be known in the previous one; may be set later."""
        self.chain = chain
        self.buffer = tf2_ros.Buffer(rospy.Duration(cache_s))
        self._listener = tf2_ros.TransformListener(self.buffer)
        self._missing_data = missing_data
        self._lock = threading.Lock()
        self._blamed: dict[tuple[str, str], str] = {}  # by the frames requested

    def knows(self, frame: str) -> bool:
        """Whether tf has ever had this frame, or it is in the chain."""
        return frame in self.chain or any(frame in (link.parent, link.child)
                                          for link in known_links(self.buffer).values())

    def find(self, parent: str, child: str, stamp: rospy.Time = NEWEST) -> Transform | None:
        """The transform of `child` in `parent` at `stamp` (0: the newest)."""
        found = self._look_up(parent, child, stamp)
        if found is not None:
            self._trust(parent, child)
        return None if found is None else found.transform

    def pose(self, parent: str, child: str, stamp: rospy.Time = NEWEST,
             wait_s: float = 0.0) -> np.ndarray | None:
        """(x, y, yaw) of `child` in `parent` at `stamp` (0: the newest); waits up to `wait_s`."""
        end = time.monotonic() + wait_s
        while (_is_askable(child, stamp) and not self.buffer.can_transform(parent, child, stamp)
               and time.monotonic() < end and not rospy.is_shutdown()):
            time.sleep(POLL)
        found = self.find(parent, child, stamp)
        return None if found is None else _in_the_plane(found)

    def newest_pose(self, parent: str, child: str, tolerance_s: float) -> np.ndarray | None:
        """(x, y, yaw) of `child` in `parent`; None if tf has none within the tolerance."""
        found = self._look_up(parent, child, NEWEST)
        if found is None:
            return None
        stamp = found.header.stamp
        if not stamp.is_zero() and (rospy.Time.now() - stamp).to_sec() > tolerance_s:
            self._blame(parent, child, stamp)  # a stamp of 0: all links are static
            return None
        self._trust(parent, child)
        return _in_the_plane(found.transform)

    def _look_up(self, parent: str, child: str, stamp: rospy.Time) -> TransformStamped | None:
        try:
            if _is_askable(child, stamp):
                return self.buffer.lookup_transform(parent, child, stamp)
        except tf2_ros.TransformException:
            pass
        self._blame(parent, child, stamp)
        return None

    def _blame(self, parent: str, child: str, stamp: rospy.Time) -> None:
        link = weakest(known_links(self.buffer), parent, child, self.chain)
        what, why, patience = _fault(link, stamp)
        with self._lock:
            settled = self._settled(parent, child) - {what}
            self._blamed[parent, child] = what
        for other in settled:
            self._missing_data.present(other)
        is_localisation = len(self.chain) > 2 and link.parent == self.chain[0]
        self._missing_data.missing(what, why, patience, is_result=is_localisation
                                   and link.newest is not None)

    def _trust(self, parent: str, child: str) -> None:
        if (parent, child) not in self._blamed:
            return
        with self._lock:
            settled = self._settled(parent, child)
        for what in settled:
            self._missing_data.present(what)

    def _settled(self, parent: str, child: str) -> set[str]:
        """What was blamed for these two frames, unless it still is for others."""
        return {self._blamed.pop((parent, child), None)} - {None, *self._blamed.values()}


def _fault(link: TfLink, stamp: rospy.Time) -> tuple[str, str, float | None]:
    """What is missing, why, and the patience with it, for an unavailable transform."""
    name = f"transform from {link.parent} to {link.child}"
    if link.newest is None:
        return name, "nothing publishes it on /tf or /tf_static", None
    age = rospy.Time.now().to_sec() - link.newest
    if age > LATE or stamp.is_zero():
        return f"new {name}", f"the newest is {age:.1f} s old", None
    ahead = stamp.to_sec() - link.newest
    return (f"{name} at the stamps of messages",
            f"they are {abs(ahead):.1f} s {'ahead of' if ahead > 0 else 'behind'} the newest one; "
            f"do the clocks of all machines agree?", ODD)


def is_far(stamp: rospy.Time) -> bool:
    """Whether it is too far from now for a tf2 lookup; 0, the newest, never is."""
    return not stamp.is_zero() and abs(stamp.to_sec() - rospy.Time.now().to_sec()) > FAR


def _is_askable(child: str, stamp: rospy.Time) -> bool:
    """Whether a tf2 lookup is safe: it would neither abort nor reject the name."""
    return not is_far(stamp) and "\0" not in child


def _in_the_plane(found: Transform) -> np.ndarray:
    return np.array([found.translation.x, found.translation.y, yaw_of(found.rotation)])
