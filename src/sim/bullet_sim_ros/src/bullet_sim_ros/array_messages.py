"""Messages of sensor_msgs whose data stay in a NumPy array until the socket takes them.

The generated classes need `bytes` and pack them once more, and rospy copies those: 6 MB for each
image of 1920x1080 and 33 MB for its points, while holding Python's GIL. The serialized messages
are the same. While the data are the same, too, only the stamp is new (LastMessage).
"""

import operator
import struct
from collections.abc import Callable, Sequence
from io import BytesIO
from typing import Generic, TypeVar

import genpy
import numpy as np
from sensor_msgs.msg import CompressedImage, Image, PointCloud2, PointField
from std_msgs.msg import Header

from bullet_sim_ros.rospy_patches import write_array

Message = TypeVar("Message", CompressedImage, Image, PointCloud2)


class ArrayImage(Image):
    """An Image whose pixels are an array."""

    def __init__(self, pixels: np.ndarray, **fields):
        """`pixels`: (h, w) or (h, w, channels), C-contiguous; `fields` are those of Image."""
        self._pixels = np.empty(0)  # the generated constructor reads every field
        super().__init__(height=pixels.shape[0], width=pixels.shape[1],
                         step=pixels.nbytes // pixels.shape[0], is_bigendian=0, **fields)
        self._pixels = pixels

    @property
    def data(self) -> bytes:
        """The pixels, for readers in this process."""
        return self._pixels.tobytes()

    @data.setter
    def data(self, _value: bytes) -> None:
        """Ignored: the generated constructor sets every field, but pixels are in the array."""

    def serialize(self, buff: BytesIO) -> None:
        """Write the message as ROS sends it."""
        self.header.serialize(buff)
        encoding = self.encoding.encode()
        buff.write(struct.pack(
            f"<III{len(encoding)}sBII", self.height, self.width, len(encoding), encoding,
            self.is_bigendian, self.step, self._pixels.nbytes))
        write_array(buff, self._pixels)


class ArrayPointCloud2(PointCloud2):
    """An organised PointCloud2 of float32 fields."""

    def __init__(self, points: np.ndarray, names: Sequence[str], **fields):
        """`points`: (h, w, len(names)) float32, C-contiguous; `fields` are those of PointCloud2."""
        self._points = np.empty(0)  # as ArrayImage's
        height, width, _ = points.shape
        step = points.strides[1]
        super().__init__(
            height=height, width=width, point_step=step, row_step=step * width, is_bigendian=False,
            fields=[PointField(name, 4 * place, PointField.FLOAT32, 1)
                    for place, name in enumerate(names)], **fields)
        self._points = points

    @property
    def data(self) -> bytes:
        """The points, for readers in this process."""
        return self._points.tobytes()

    @data.setter
    def data(self, _value: bytes) -> None:
        """As ArrayImage's."""

    def serialize(self, buff: BytesIO) -> None:
        """Write the message as ROS sends it."""
        self.header.serialize(buff)
        buff.write(struct.pack("<III", self.height, self.width, len(self.fields)))
        for field in self.fields:
            field.serialize(buff)
        buff.write(struct.pack("<?III", self.is_bigendian, self.point_step, self.row_step,
                               self._points.nbytes))
        write_array(buff, self._points)
        buff.write(struct.pack("<?", self.is_dense))


class LastMessage(Generic[Message]):
    """A topic's last message, and the objects from which it was made."""

    def __init__(self):
        self.forget()

    def forget(self) -> None:
        """Free its memory."""
        self._sources: tuple[object, ...] = ()
        self._message: Message | None = None

    def of(self, stamp: genpy.Time, make: Callable[[], Message], *sources: object) -> Message:
        """`make`'s message, or the last one with this stamp if `sources` are the same objects.

        They must not change any more. A message is never changed: a latched one may be sent later.
        """
        if (self._message is not None and len(sources) == len(self._sources)
                and all(map(operator.is_, sources, self._sources))):
            return _restamped(self._message, stamp)
        self.forget()  # before there is another one
        self._message, self._sources = make(), sources
        return self._message


def _restamped(message: Message, stamp: genpy.Time) -> Message:
    """A copy with the same data and another stamp."""
    copied = object.__new__(type(message))
    of_arrays = getattr(message, "__dict__", {})  # and of generated classes, which have none
    fields = [name for name in message.__slots__
              if not isinstance(getattr(type(message), name), property)]
    for name in (*fields, *of_arrays):
        setattr(copied, name, getattr(message, name))
    copied.header = Header(stamp=stamp, frame_id=message.header.frame_id)
    return copied
