"""What rospy writes messages into; large arrays are not copied, but sent from where they are."""

from io import BytesIO

import numpy as np


class MessageBuffer(BytesIO):
    """In the place of rospy's BytesIO. Positions count the arrays in."""

    def __init__(self):
        super().__init__()
        self._arrays: list[tuple[int, int, memoryview]] = []  # after so many bytes, of them own

    def append(self, array: np.ndarray) -> None:
        """At the end, a C-contiguous array, which must not change any more."""
        own = super().tell()
        self._arrays.append((self.tell(), own, array.reshape(-1).view(np.uint8).data))

    def tell(self) -> int:
        """Bytes before the position."""
        place = super().tell()
        return place + sum(array.nbytes for _, own, array in self._arrays if own <= place)

    def seek(self, position: int) -> int:
        """To that many bytes from the start, none of them inside an array."""
        super().seek(position - sum(
            array.nbytes for start, _, array in self._arrays if start < position))
        return position

    def truncate(self, size: int) -> int:
        """Forget what comes after so many bytes, and all arrays."""
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
    """Into a message that is written; copied only where `buff` is not one of ours."""
    if isinstance(buff, MessageBuffer):
        buff.append(array)
    else:
        buff.write(array.data)
