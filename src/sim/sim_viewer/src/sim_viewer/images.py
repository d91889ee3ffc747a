"""Image topics, among them those of cv2 windows, as JPEG images while somebody watches."""

import time
from collections.abc import Callable
from typing import Any

import rospy
from sensor_msgs.msg import CompressedImage, Image

from sim_viewer.context import Context, Node
from sim_viewer.pictures import to_jpeg
from sim_viewer.registry import Refused, argument, operation, watchable
from sim_viewer.tools.master import MasterView

RATE_HZ = 20.0  # at most
WIDTHS_PX = range(16, 961)
WIDTH_PX = 640
KINDS = {"sensor_msgs/Image": Image, "sensor_msgs/CompressedImage": CompressedImage}
COMPRESSED = "/compressed"
LARGEST_MESSAGE = 1 << 24  # bytes read at once, so that no old image waits in the socket


@operation("image_topics")
async def image_topics(context: Context) -> list[str]:
    """Image topics with a publisher; compressed ones only if there is no raw one."""
    return await context.run_in_thread(_offered, context.node.shared(MasterView))


def _offered(master: MasterView) -> list[str]:
    published, types = master.state().publishers, master.types()
    topics = {topic for topic in published if types.get(topic) in KINDS}
    return sorted(topic for topic in topics if not _is_twin(topic, topics))


def _is_twin(topic: str, topics: set[str]) -> bool:
    base, _, last = topic.rpartition("/")
    return base in topics and last in ("compressed", "compressedDepth")


class Stream:
    """One topic at one width, shared by all its watchers. Messages arrive in rospy's thread, which
    drops those that come too fast without reading them."""

    def __init__(self, topic: str, kind: type, width: int):
        self._kind = kind
        self._width = width
        self._watchers: list[Callable[..., None]] = []
        self._due = 0.0  # s, monotonic
        self._last: bytes | None = None
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._take, queue_size=1,
                                            buff_size=LARGEST_MESSAGE)

    def add(self, send: Callable[..., None]) -> None:
        """Add a watcher, and send it the last image."""
        if self._last is not None:
            send(self._last)
        self._watchers = [*self._watchers, send]

    def remove(self, send: Callable[..., None]) -> bool:
        """Remove a watcher; returns whether it was the last, after which nothing is subscribed."""
        self._watchers = [other for other in self._watchers if other is not send]
        if not self._watchers:
            self._subscriber.unregister()
        return not self._watchers

    def _take(self, raw: rospy.AnyMsg) -> None:
        now = time.monotonic()
        if now < self._due:
            return
        # The rate holds on average: of 30 images a second 20 are sent, not 15.
        self._due = max(self._due + 1 / RATE_HZ, now - 1 / RATE_HZ)
        try:
            self._last = to_jpeg(self._kind().deserialize(raw._buff), self._width)
        except Refused as error:
            self._send_to_all({"error": str(error)})
        except Exception as error:  # caused by a message of another node
            rospy.logwarn_throttle(10, f"{self._subscriber.resolved_name}: {error}")
            self._send_to_all({"error": f"{type(error).__name__}: {error}"})
        else:
            self._send_to_all(self._last)

    def _send_to_all(self, data: Any) -> None:
        for send in self._watchers:
            send(data)


class Streams:
    """All streams that have watchers."""

    def __init__(self, node: Node):
        self._streams: dict[tuple[str, int], Stream] = {}

    def add(self, topic: str, kind: type, width: int, send: Callable[..., None]) -> None:
        """Add a watcher; in the loop's thread, as all methods here."""
        key = (topic, width)
        if key not in self._streams:
            self._streams[key] = Stream(topic, kind, width)
        self._streams[key].add(send)

    def remove(self, topic: str, width: int, send: Callable[..., None]) -> None:
        """Remove a watcher."""
        stream = self._streams.get((topic, width))
        if stream is not None and stream.remove(send):
            del self._streams[topic, width]


@watchable("image")
class ImageWatch:
    """Arguments: `topic`, and the largest `width` needed, px. Events are JPEG files, or an object
    with an `error` if an image cannot be shown."""

    def __init__(self, context: Context, args: dict[str, Any], send: Callable[..., None]):
        self._context, self._send = context, send
        self._requested = argument(args, "topic", str)
        width = argument(args, "width", int, WIDTH_PX)
        self._width = max(WIDTHS_PX.start, min(width, WIDTHS_PX.stop - 1))
        self._streams: Streams = context.node.shared(Streams)
        self._topic: str | None = None

    async def start(self) -> None:
        """Subscribe to the compressed topic if there is one, else to the raw one."""
        master = self._context.node.shared(MasterView)
        topic, kind = await self._context.run_in_thread(_find, master, self._requested)
        self._topic = topic
        self._streams.add(topic, kind, self._width, self._send)

    async def stop(self) -> None:
        if self._topic is not None:
            self._streams.remove(self._topic, self._width, self._send)


def sources(master: MasterView, wished: str) -> list[str]:
    """The topics to subscribe to for an image topic: the compressed one if it is published, else
    the topic itself; both if neither is published yet."""
    published, types = master.state().publishers, master.types()
    offered = [topic for topic in (wished + COMPRESSED, wished)
               if topic in published and types.get(topic) in KINDS]
    return offered[:1] or [wished, wished + COMPRESSED]


def _find(master: MasterView, wished: str) -> tuple[str, type]:
    (topic, *others), types = sources(master, wished), master.types()
    if not others:
        return topic, KINDS[types[topic]]
    raise Refused(f"{wished!r:.80} is not an image topic that somebody publishes; "
                  f"there are {', '.join(_offered(master)) or 'none'}")
