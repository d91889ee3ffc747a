"""Image topics, among them those of cv2 windows, as JPEG images while somebody watches."""

import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import rospy
from cv_bridge import CvBridge, CvBridgeError
from sensor_msgs.msg import CompressedImage, Image

from bullet_sim.meshes.images import JPEG, image_size
from sim_viewer.registry import Context, Node, Refused, argument, operation, watchable
from sim_viewer.tools.master import MasterView

QUALITY = 80  # of 100
TALLEST_PX = 2000
_bridge = CvBridge()
RATE_HZ = 20.0  # at most
WIDTHS_PX = range(16, 961)
WIDTH_PX = 640
KINDS = {"sensor_msgs/Image": Image, "sensor_msgs/CompressedImage": CompressedImage}
COMPRESSED = "/compressed"
STAMPED = 12  # bytes of a message before its frame: its number and its time
LARGEST_MESSAGE = 1 << 24  # bytes read at once, so that no old image waits in the socket


def to_jpeg(msg: Image | CompressedImage, width: int) -> bytes:
    """A JPEG file, at most `width` px wide; a JPEG that is small enough is returned as it is.
    Refused says why an image cannot be shown."""
    if hasattr(msg, "format"):
        data = bytes(msg.data)
        if 0 < _jpeg_width(data) <= width:
            return data
        picture = _decode(data, width)
    else:
        picture = visible(msg)
    height_px, width_px = picture.shape[:2]
    shrink = max(width_px / width, height_px / TALLEST_PX)
    if shrink > 1:
        size = (max(1, round(width_px / shrink)), max(1, round(height_px / shrink)))
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    return cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])[1].tobytes()


def visible(msg: Image) -> np.ndarray:
    """(h, w) or (h, w, 3) uint8, grey or BGR. Depths and 16-bit values are scaled from black to
    white between the image's least and largest; values that are not finite are black. Encodings
    that only name the number of channels (8UC3) mean BGR, as in OpenCV. Refused: no image."""
    if not msg.width or not msg.height:
        raise Refused("the picture has no pixels")
    try:
        picture = _bridge.imgmsg_to_cv2(msg)
        named = "C" not in msg.encoding  # bgr8 and its like, not 8UC3
        if named and picture.dtype == np.uint8 and msg.encoding != "mono8":
            return _bridge.imgmsg_to_cv2(msg, "bgr8")
    except (CvBridgeError, ValueError, TypeError, MemoryError) as error:
        raise _cannot(msg, str(error)) from None
    channels = 1 if picture.ndim == 2 else picture.shape[2]
    if channels not in (1, 3, 4):
        raise _cannot(msg, f"{channels} numbers a pixel are not a colour")
    colours = picture[..., :3] if channels == 4 else picture
    if msg.encoding.startswith("rgb"):
        colours = colours[..., ::-1]
    return colours if colours.dtype == np.uint8 else _spread(colours)


def _cannot(msg: Image, reason: str) -> Refused:
    return Refused(f"a picture of {msg.width} x {msg.height} in {msg.encoding!r:.30} cannot be "
                   f"shown: {reason}")


def _spread(values: np.ndarray) -> np.ndarray:
    values = np.asarray(values, np.float32)
    finite = np.isfinite(values)
    low, high = (values[finite].min(), values[finite].max()) if finite.any() else (0.0, 1.0)
    span = max(float(high) - float(low), 1e-6)
    grey = np.where(finite, values, low).astype(np.float64) - float(low)
    grey *= 255 / span
    return grey.astype(np.uint8)


def _decode(data: bytes, width: int) -> np.ndarray:
    """Decode a compressed image; JPEGs at least twice as wide as `width` are read at half size."""
    large = _jpeg_width(data) >= 2 * width
    mode = cv2.IMREAD_REDUCED_COLOR_2 if large else cv2.IMREAD_COLOR
    picture = cv2.imdecode(np.frombuffer(data, np.uint8), mode) if data else None
    if picture is None:
        raise Refused("the compressed picture is of a kind that cannot be read")
    return picture


def _jpeg_width(data: bytes) -> int:
    """The width in px; 0 if the data are not a JPEG."""
    size = image_size(data) if data.startswith(JPEG) else None
    return size[0] if size else 0


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
    drops those that come too fast without reading them. What differs from the last one in its
    header alone is the same JPEG."""

    def __init__(self, topic: str, kind: type, width: int):
        self._kind = kind
        self._width = width
        self._watchers: list[Callable[..., None]] = []
        self._due = 0.0  # s, monotonic
        self._last: bytes | None = None
        self._shown: bytes | None = None  # the last image's message, from its frame on
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
        shown = raw._buff[STAMPED:]
        if shown == self._shown:
            self._send_to_all(self._last)
            return
        self._shown = None  # an error is told each time
        try:
            self._last = to_jpeg(self._kind().deserialize(raw._buff), self._width)
            self._shown = shown
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
