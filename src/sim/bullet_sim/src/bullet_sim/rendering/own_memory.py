"""Memory of its own for what is large and stays a while: given back as soon as it is free.

The C library takes blocks of some MB from its heap, where the environment says so, because that is
quick for what lasts a moment (see the environment hook of bullet_sim_ros). But freed blocks of what
lasts leave holes there, which the next do not always fit into: memory goes up and down by them.
"""

import contextlib
import ctypes
import math
import mmap
import os
from collections.abc import Iterator

import numpy as np

VARIABLE = "MALLOC_MMAP_THRESHOLD_"  # bytes, from which on blocks are none of the heap's
M_MMAP_THRESHOLD = -3  # mallopt's name of the same, in the GNU library's malloc.h
LARGE = 1 << 20  # bytes


def own_array(shape: tuple[int, ...]) -> np.ndarray:
    """A uint8 array of zeros outside the heap."""
    return np.frombuffer(mmap.mmap(-1, math.prod(shape)), np.uint8).reshape(shape)


@contextlib.contextmanager
def own_blocks() -> Iterator[None]:
    """What libraries allocate meanwhile is outside the heap from `LARGE` on."""
    threshold = os.environ.get(VARIABLE, "")
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)  # not every C library has it
    if mallopt is None or not threshold.isdecimal():
        yield
        return
    mallopt(M_MMAP_THRESHOLD, LARGE)
    try:
        yield
    finally:
        mallopt(M_MMAP_THRESHOLD, int(threshold))
