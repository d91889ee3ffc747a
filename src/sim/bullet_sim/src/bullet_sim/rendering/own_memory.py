"""Separate memory for large, longer-lived data: returned to the system as soon as it is free.

The C library takes blocks of some MB from its heap, if the environment says so, because that is
fast for short-lived data (see the environment hook of bullet_sim_ros). But freed blocks of
longer-lived data leave holes there, into which the next ones do not always fit, so memory varies.
"""

import contextlib
import ctypes
import math
import mmap
import os
from collections.abc import Iterator

import numpy as np

VARIABLE = "MALLOC_MMAP_THRESHOLD_"  # bytes, from which on blocks are not in the heap
M_MMAP_THRESHOLD = -3  # mallopt's name of the same, in the GNU library's malloc.h
LARGE = 1 << 20  # bytes


def own_array(shape: tuple[int, ...]) -> np.ndarray:
    """A uint8 array of zeros outside the heap."""
    return np.frombuffer(mmap.mmap(-1, math.prod(shape)), np.uint8).reshape(shape)


@contextlib.contextmanager
def own_blocks() -> Iterator[None]:
    """Within it, libraries' allocations of at least `LARGE` are outside the heap."""
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
