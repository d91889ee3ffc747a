"""Memory of large messages goes back to the system."""

import ctypes

M_MMAP_THRESHOLD = -3  # of glibc's malloc.h
LARGE = 1 << 20  # bytes


def give_back_large_blocks() -> None:
    """From now on, as soon as they are free.

    glibc itself raises this threshold to 32 MB when such a block is freed. Then each worker thread
    keeps the clouds and maps that it has had: 0.8 GB after some minutes.
    """
    ctypes.CDLL(None).mallopt(M_MMAP_THRESHOLD, LARGE)
