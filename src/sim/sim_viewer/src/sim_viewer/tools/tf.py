"""The tree of tf frames, as drawn by view_frames: each frame's publisher, rate and age."""

import math
import threading
import time
from collections import deque
from dataclasses import dataclass, field
from typing import Any

from tf2_msgs.msg import TFMessage

from bullet_sim.pose import rpy_from_quaternion
from sim_viewer.registry import watchable
from sim_viewer.subscription import Subscription
from sim_viewer.tools import names
from sim_viewer.tools.clock import SharedClock
from sim_viewer.tools.paced import Paced

RATE_WINDOW = 5.0  # s of wall time
MOST_FRAMES = 1_000


@dataclass
class Link:
    """One frame below its parent."""

    parent: str
    publisher: str
    static: bool
    stamp: float = 0.0  # s, of the newest
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, in the parent
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)  # x, y, z, w
    times: deque[float] = field(default_factory=lambda: deque(maxlen=600))  # s, wall
    others: dict[str, float] = field(default_factory=dict)  # other parent -> wall s, its last


class FrameTree:
    """The transforms of /tf and /tf_static. `add` and `rows` may come from different threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._links: dict[str, Link] = {}

    def add(self, transforms: list, publisher: str, static: bool, now: float) -> None:
        """Add a message's transforms, received at `now` s of wall time."""
        with self._lock:
            for one in transforms:
                self._add(one, publisher, static, now)

    def _add(self, one: Any, publisher: str, static: bool, now: float) -> None:
        # tf2 has no leading slashes; old tf nodes write them.
        child, parent = one.child_frame_id.lstrip("/"), one.header.frame_id.lstrip("/")
        link = self._links.get(child)
        if link is None:
            if len(self._links) >= MOST_FRAMES:
                return
            link = self._links[child] = Link(parent, publisher, static)
        if link.parent != parent:
            link.others[link.parent] = now
            link.others.pop(parent, None)
        link.parent, link.publisher, link.static = parent, publisher, static
        link.stamp = one.header.stamp.to_sec()
        shift, turn = one.transform.translation, one.transform.rotation
        link.place = (shift.x, shift.y, shift.z)
        link.rotation = (turn.x, turn.y, turn.z, turn.w)
        link.times.append(now)

    def rows(self, wall: float, now: float) -> list[dict[str, Any]]:
        """Frames from the roots down, each after its parent; `now` is in the stamps' time.

        A row has frame, depth, parent (None: a root), and but for roots publisher, static, rate
        (1/s), age (s; None if static), place (m), angles (degrees: roll, pitch, yaw), problem.
        """
        with self._lock:
            links = dict(self._links)
            read = {frame: self._row(frame, link, wall, now) for frame, link in links.items()}
        children: dict[str, list[str]] = {}
        for frame, link in links.items():
            children.setdefault(link.parent, []).append(frame)
        found: list[dict[str, Any]] = []
        seen: set[str] = set()
        for root in sorted(set(children) - set(links)):
            found.append({"frame": root, "depth": 0, "parent": None})
            self._descend(root, 1, children, read, found, seen)
        for frame in sorted(set(links) - seen):  # reached from no root
            if frame not in seen:
                read[frame]["problem"] = "loop"
                seen.add(frame)
                found.append({**read[frame], "depth": 0})
                self._descend(frame, 1, children, read, found, seen)
        return found

    @staticmethod
    def _descend(start: str, depth: int, children: dict[str, list[str]], read: dict[str, dict],
                 found: list[dict[str, Any]], seen: set[str]) -> None:
        waiting = [(frame, depth) for frame in sorted(children.get(start, []), reverse=True)]
        while waiting:
            frame, depth = waiting.pop()
            if frame in seen:
                continue
            seen.add(frame)
            found.append({**read[frame], "depth": depth})
            waiting += [(below, depth + 1)
                        for below in sorted(children.get(frame, []), reverse=True)]

    @staticmethod
    def _row(frame: str, link: Link, wall: float, now: float) -> dict[str, Any]:
        recent = [moment for moment in link.times if moment > wall - RATE_WINDOW]
        span = recent[-1] - recent[0] if recent else 0.0
        rivals = sorted(p for p, moment in link.others.items() if moment > wall - RATE_WINDOW)
        return {"frame": frame, "parent": link.parent, "publisher": link.publisher,
                "static": link.static, "rate": (len(recent) - 1) / span if span > 0 else 0.0,
                "age": None if link.static else now - link.stamp,
                "place": link.place,
                "angles": [math.degrees(angle) for angle in rpy_from_quaternion(link.rotation)],
                "problem": "parents: " + ", ".join([link.parent, *rivals]) if rivals else ""}


@watchable("tf")
class Tf(Paced):
    """Sends the rows of FrameTree once a second."""

    PERIOD = 1.0

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._tree = FrameTree()
        self._clock: SharedClock = context.node.shared(SharedClock)

    def open(self) -> None:
        self.closing.enter_context(self._clock.held())
        for topic, static in ((names.TF, False), (names.TF_STATIC, True)):
            subscription = Subscription(topic, TFMessage, self._take, static)
            self.closing.callback(subscription.unregister)

    def collect(self) -> Any:
        return self.changed(self._tree.rows(time.monotonic(), self._clock.now()))

    def _take(self, message: TFMessage, static: bool) -> None:
        publisher = (message._connection_header or {}).get("callerid", "")
        self._tree.add(message.transforms, publisher, static, time.monotonic())
