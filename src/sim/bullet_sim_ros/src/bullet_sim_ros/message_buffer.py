"""What rospy writes messages into; large arrays are not copied, but sent from where they are."""

from io import BytesIO

import numpy as np


class MessageBuffer(BytesIO):
    """In the place of rospy's BytesIO. Positions count the arrays in."""

    def __init__(self):
        super().__init__()
        self._arrays: list[tuple[int, memoryview]] = []  # and how many other bytes come before

    def append(self, array: np.ndarray) -> None:
        """At the end, a C-contiguous array, which must not change any more."""
        self._arrays.append((super().tell(), array.reshape(-1).view(np.uint8).data))

    def tell(self) -> int:
        """Bytes before the position."""
        place = super().tell()
        return place + sum(array.nbytes for before, array in self._arrays if before <= place)

    def seek(self, position: int) -> int:
        """To that many bytes from the start, none of them an array's."""
        arrays = sum(array.nbytes for before, array in self._arrays if before < position)
        super().seek(position - arrays)
        return position

    def truncate(self, size: int) -> int:
        """Forget what comes after so many bytes, and all arrays."""
        self._arrays.clear()
        return super().truncate(size)

    def getvalue(self) -> bytes | list[memoryview]:
        """The message, in pieces if it has arrays."""
        if not self._arrays:
            return super().getvalue()
        own, pieces, start = memoryview(super().getvalue()), [], 0
        for before, array in self._arrays:
            pieces += [own[start:before], array]
            start = before
        return [piece for piece in [*pieces, own[start:]] if piece]


def write_array(buff: BytesIO, array: np.ndarray) -> None:
    """Into a message that is written; copied only where `buff` is not one of ours."""
    if isinstance(buff, MessageBuffer):
        buff.append(array)
    else:
        buff.write(array.data)
