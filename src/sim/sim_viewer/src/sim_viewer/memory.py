"""Returns the memory of large messages to the operating system."""

import ctypes

M_MMAP_THRESHOLD = -3  # of glibc's malloc.h
LARGE = 1 << 20  # bytes


def give_back_large_blocks() -> None:
    """From now on, return large blocks to the system as soon as they are freed.

    By default glibc raises this threshold to 32 MB when such a block is freed. Then each worker
    thread keeps the memory of its clouds and maps: 0.8 GB after some minutes.
    """
    ctypes.CDLL(None).mallopt(M_MMAP_THRESHOLD, LARGE)
