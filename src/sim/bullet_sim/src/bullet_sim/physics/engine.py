"""PyBullet, imported and called with its output suppressed, because learners read the terminal."""

import contextlib
import ctypes
import os
import sys
from collections.abc import Iterator


@contextlib.contextmanager
def quiet(*descriptors: int) -> Iterator[None]:
    """Redirect file descriptors to /dev/null: PyBullet's C code prints there, not to sys.stdout."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = {descriptor: os.dup(descriptor) for descriptor in descriptors}
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        for descriptor in descriptors:
            os.dup2(sink, descriptor)
        yield
    finally:
        ctypes.CDLL(None).fflush(None)  # also the contents of C's buffer
        for descriptor, copy in kept.items():
            os.dup2(copy, descriptor)
            os.close(copy)
        os.close(sink)


STDOUT, STDERR = 1, 2

with quiet(STDOUT, STDERR):  # it prints its build time when first imported
    import pybullet

EngineError = pybullet.error

__all__ = ["STDERR", "STDOUT", "EngineError", "pybullet", "quiet"]
