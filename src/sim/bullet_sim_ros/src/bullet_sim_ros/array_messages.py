"""Messages of sensor_msgs whose data stay in a NumPy array until the socket takes them.

The generated classes need `bytes` and pack them once more, and rospy copies those: 6 MB for each
image of 1920x1080 and 33 MB for its points, while holding Python's GIL. The serialized messages
are the same.
"""

import struct
from collections.abc import Sequence
from io import BytesIO

import numpy as np
from sensor_msgs.msg import Image, PointCloud2, PointField

from bullet_sim_ros.rospy_patches import write_array


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
