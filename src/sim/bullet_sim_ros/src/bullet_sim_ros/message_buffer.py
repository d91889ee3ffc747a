"""A buffer that rospy serializes messages into; large arrays are sent without being copied."""

from io import BytesIO

import numpy as np


class MessageBuffer(BytesIO):
    """Replaces rospy's BytesIO. Positions include the arrays."""

    def __init__(self):
        super().__init__()
        self._arrays: list[tuple[int, int, memoryview]] = []  # start, bytes of our own before it

    def append(self, array: np.ndarray) -> None:
        """Append a C-contiguous array, which must not change any more."""
        own = super().tell()
        self._arrays.append((self.tell(), own, array.reshape(-1).view(np.uint8).data))

    def tell(self) -> int:
        """The number of bytes before the position."""
        place = super().tell()
        return place + sum(array.nbytes for _, own, array in self._arrays if own <= place)

    def seek(self, position: int) -> int:
        """Go to a position in bytes from the start, which is not inside an array."""
        super().seek(position - sum(
            array.nbytes for start, _, array in self._arrays if start < position))
        return position

    def truncate(self, size: int) -> int:
        """Drop everything after `size` bytes, and all arrays."""
        self._arrays.clear()
        return super().truncate(size)

    def getvalue(self) -> bytes | list[memoryview]:
        """The message, in pieces if it has arrays."""
        if not self._arrays:
            return super().getvalue()
        written, pieces, begin = memoryview(super().getvalue()), [], 0
        for _, own, array in self._arrays:
            pieces += [written[begin:own], array]
            begin = own
        return [piece for piece in [*pieces, written[begin:]] if piece]


def write_array(buff: BytesIO, array: np.ndarray) -> None:
    """Write an array into a message; it is copied only if `buff` is not a MessageBuffer."""
    if isinstance(buff, MessageBuffer):
        buff.append(array)
    else:
        buff.write(array.data)
