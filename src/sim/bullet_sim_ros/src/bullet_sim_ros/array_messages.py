"""Messages of sensor_msgs whose data stay in their array until they are written to the wire.

The generated classes want `bytes` and pack them once more: two copies, of 6 MB for each picture of
1920x1080 and of 33 MB for its points, with Python's lock held. On the wire both are the same.
"""

import struct
from collections.abc import Sequence
from io import BytesIO

import numpy as np
from sensor_msgs.msg import Image, PointCloud2, PointField

from bullet_sim.profiler import Profiler


class ArrayImage(Image):
    """An Image of an array's pixels."""

    def __init__(self, pixels: np.ndarray, profiler: Profiler | None = None, **fields):
        """`pixels`: (h, w) or (h, w, channels), C-contiguous; `fields` are those of Image."""
        self._pixels = np.empty(0)  # the generated constructor reads every field
        self._profiler = profiler or Profiler()
        super().__init__(height=pixels.shape[0], width=pixels.shape[1],
                         step=pixels.nbytes // pixels.shape[0], is_bigendian=0, **fields)
        self._pixels = pixels

    @property
    def data(self) -> bytes:
        """The pixels, for readers in this process."""
        return self._pixels.tobytes()

    @data.setter
    def data(self, _value: bytes) -> None:
        """The generated constructor sets every field; pixels come by the array alone."""

    def serialize(self, buff: BytesIO) -> None:
        """Write the message as ROS sends it."""
        with self._profiler.measure("serialise"):
            self.header.serialize(buff)
            encoding = self.encoding.encode()
            buff.write(struct.pack(
                f"<III{len(encoding)}sBII", self.height, self.width, len(encoding), encoding,
                self.is_bigendian, self.step, self._pixels.nbytes))
            buff.write(self._pixels.data)


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
        buff.write(self._points.data)
        buff.write(struct.pack("<?", self.is_dense))
