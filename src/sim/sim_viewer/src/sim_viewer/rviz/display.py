"""`rviz_display`: one display of one page, from its topic to frames of drawing.py.

Events are bytes, a frame, or {"status": [[name, level, text]], "namespaces": of markers}. The page
confirms each frame by `rviz_drawn` once it is drawn, and only then the next one, the newest by
then, is sent. It changes options by `rviz_change`.
"""

import asyncio
import contextlib
import threading
import time
from typing import Any

import numpy as np
import rospy
from roslib.message import get_message_class

from sim_viewer.images import sources as image_sources
from sim_viewer.registry import Context, Node, Refused, argument, operation, watchable
from sim_viewer.rviz.display_type import DisplayType, Drawer, Problem
from sim_viewer.rviz.drawing import Part, encode, frame, points_of
from sim_viewer.rviz.options import check_all
from sim_viewer.rviz.showing import Pace, Showing
from sim_viewer.rviz.types import TYPES
from sim_viewer.rviz.view import RosView
from sim_viewer.subscription import decode
from sim_viewer.tools.clock import SharedClock
from sim_viewer.tools.master import MasterView
from sim_viewer.tools.names import is_topic
from sim_viewer.transforms import Transforms

RATE_HZ = 15.0  # of frames, at most
LONGEST_REST = 0.5  # s at most between two checks for something new
STATUS_PERIOD = 0.5  # s at least between two status events
LARGEST_MESSAGE = 1 << 24  # bytes read at once


class Displays(dict):
    """The displays of all pages, by client and the display's number."""

    def __init__(self, node: Node):
        super().__init__()


@watchable("rviz_display")
class Display:
    """Arguments: `display`, the page's number for it, `class`, `topic`, `options`, `frame`: the
    fixed frame."""

    def __init__(self, context: Context, args: dict[str, Any], send: Any):
        self._context, self._send = context, send
        kind = TYPES.get(argument(args, "class", str))
        if kind is None:
            raise Refused("not supported here")
        self._kind = kind
        self._key = (context.client, argument(args, "display", int))
        self.topic = argument(args, "topic", str, kind.topic)
        self._wanted = (_checked(kind, argument(args, "options", dict, {})),
                        argument(args, "frame", str).lstrip("/"))
        self._view = RosView(context.node, self._key, self._wanted[1])
        self._showing = Showing(kind, self._wanted[0], self._view, self._read)
        self._pace = Pace()
        self._parts: list[Part] = []  # of the frame that was sent last
        self._known: set[str] = set()  # keys of parts that the page has
        self._last = b""
        self._status: tuple[Any, float] = (None, 0.0)  # the last one, and when the next may be sent
        self._news = asyncio.Event()
        self._closing = contextlib.ExitStack()
        self._lock = threading.Lock()  # a page may disconnect while its display is being opened
        self._ended = False
        self._task: asyncio.Task | None = None

    async def start(self) -> None:
        """Refused if another display of the page has the number."""
        shown: Displays = self._context.node.shared(Displays)
        if self._key in shown:
            raise Refused(f"display is {self._key[1]}, which is another one's number")
        shown[self._key] = self
        await self._context.run_in_thread(self._open)
        self._task = self._context.loop.create_task(self._run())

    async def stop(self) -> None:
        shown: Displays = self._context.node.shared(Displays)
        if shown.get(self._key) is self:
            del shown[self._key]
        if self._task:
            self._task.cancel()
        await self._context.run_in_thread(self._close)

    @property
    def drawer(self) -> Drawer:
        """The display's state, which draws its parts."""
        return self._showing.drawer

    def look_soon(self) -> None:
        """Wake the display, as there is something new; in the loop."""
        self._news.set()

    def drawn(self, number: int) -> None:
        """The page has drawn a frame; in the loop."""
        if self._pace.drawn(number, time.monotonic()):
            self._known = {part.key for part in self._parts if part.key}
            self._news.set()

    def change(self, options: dict[str, Any], frame: str) -> None:
        """Set options and fixed frame; Refused if the options are invalid; in the loop."""
        self._wanted = _checked(self._kind, options), frame.lstrip("/")
        self._news.set()

    def _open(self) -> None:
        with self._lock:
            if not self._ended:
                self._subscribe()

    def _close(self) -> None:
        with self._lock:
            self._ended = True
            self._closing.close()

    def _subscribe(self) -> None:
        for shared in (Transforms, SharedClock):
            self._closing.enter_context(self._context.node.shared(shared).held())
        self._closing.callback(self._view.close)
        if not self._kind.messages:
            return
        if not self.topic.strip("/ "):
            self._showing.fail("Topic", "Error subscribing: Empty topic name")
            return
        if not is_topic(self.topic):
            self._showing.fail("Topic", f"Error subscribing: {self.topic!r:.40} is not the name of "
                                        "a topic")
            return
        topics = [self.topic]
        if "sensor_msgs/CompressedImage" in self._kind.messages:
            topics = image_sources(self._context.node.shared(MasterView), self.topic)
        if self._kind.beside:
            topics.append(self._kind.beside_topic(self.topic))
        try:
            for topic in topics:
                one = rospy.Subscriber(topic, rospy.AnyMsg, self._take,
                                       buff_size=LARGEST_MESSAGE, tcp_nodelay=True)
                self._closing.callback(one.unregister)
        except (ValueError, rospy.ROSException) as error:
            self._showing.fail("Topic", f"Error subscribing: {error}")

    def _take(self, raw: rospy.AnyMsg) -> None:
        """In rospy's threads."""
        self._showing.put(raw, raw._connection_header.get("type") == self._kind.beside)
        with contextlib.suppress(RuntimeError):  # the loop has ended
            self._context.loop.call_soon_threadsafe(self._news.set)

    def _read(self, raw: rospy.AnyMsg) -> tuple[Any, str]:
        header = raw._connection_header
        name = header.get("type", "")
        if name not in (*self._kind.messages, self._kind.beside):
            raise Problem(f"{self.topic} is {name}, and this display shows "
                          f"{' or '.join(self._kind.messages)}")
        if len(raw._buff) > self._kind.most_bytes:
            raise Problem(f"a message of {len(raw._buff) >> 20} MB is larger than the "
                          f"{self._kind.most_bytes >> 20} MB that this display reads")
        try:
            return decode(raw, get_message_class(name)), header.get("callerid", "")
        except Exception as error:  # a publisher with another definition of the type
            raise Problem(f"this is not a {name}: {error}") from None

    async def _run(self) -> None:
        while True:
            self._news.clear()
            if self._pace.free:
                await self._draw()
            self._send_status()
            await asyncio.sleep(1 / RATE_HZ)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._news.wait(), self._kind.period or LONGEST_REST)

    async def _draw(self) -> None:
        try:
            data = await self._context.run_in_thread(self._look)
        except Exception as error:  # caused by a message of another node
            self._showing.stumble(error)
            return
        if data:
            self._send(data)

    def _look(self) -> bytes | None:
        """A frame, if there is something new."""
        self._view.most_points = self._pace.most_points
        self._showing.change(*self._wanted)
        with np.errstate(all="ignore"):  # caused by numbers of another node
            parts = self._showing.look()
            if parts is None:
                return None
            content = encode(parts, self._known)
        if content == self._last:
            return None
        self._last, self._parts = content, parts
        return frame(self._pace.sent(points_of(parts), time.monotonic()), content)

    def _send_status(self) -> None:
        status = {"status": [[name, level, text]
                             for name, (level, text) in list(self._showing.statuses.items())],
                  "namespaces": self._showing.namespaces}
        last, due = self._status
        if status != last and time.monotonic() >= due:
            self._status = status, time.monotonic() + STATUS_PERIOD
            self._send(status, keep=True)


def _checked(kind: DisplayType, options: dict[str, Any]) -> dict[str, Any]:
    try:
        return check_all(kind.options, options)
    except ValueError as error:
        raise Refused(str(error)) from None


def find_display(context: Context, number: int) -> Display:
    """The page's display of this number; Refused if there is none."""
    found = context.node.shared(Displays).get((context.client, number))
    if found is None:
        raise Refused(f"display is {number}, and this page shows no such one")
    return found


@operation("rviz_drawn")
async def rviz_drawn(context: Context, display: int, frame: int) -> None:
    """The page has drawn this frame of a display; Refused if there is no such display."""
    find_display(context, display).drawn(frame)


@operation("rviz_change")
async def rviz_change(context: Context, display: int, options: dict, frame: str) -> None:
    """Set other options or another fixed frame; Refused if they are invalid."""
    find_display(context, display).change(options, frame)
