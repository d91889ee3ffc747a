"""sensor_msgs/Image that goes out without being copied first."""

import struct
from io import BytesIO

import numpy as np
from sensor_msgs.msg import Image

from bullet_sim.profiler import Profiler


class ArrayImage(Image):
    """An Image whose pixels stay in their array until they are written to the wire.

    The generated class wants `bytes` and packs them once more: two copies of 6 MB for each picture
    of 1920x1080, with Python's lock held. On the wire both are the same.
    """

    def __init__(self, pixels: np.ndarray, profiler: Profiler | None = None, **fields):
        """`pixels`: (h, w) or (h, w, channels), C-contiguous; `fields` are those of Image."""
        self._pixels = pixels
        self._profiler = profiler or Profiler()
        super().__init__(height=pixels.shape[0], width=pixels.shape[1],
                         step=pixels.nbytes // pixels.shape[0], is_bigendian=0, **fields)

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
