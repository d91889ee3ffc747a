"""PyBullet, imported and called without its chatter: learners read the terminal."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator


@contextlib.contextmanager
def quiet_stdout() -> Iterator[None]:
    """Send file descriptor 1 to /dev/null: PyBullet's C++ prints there, past sys.stdout."""
    sys.stdout.flush()
    kept = os.dup(1)
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(sink)
        os.close(kept)


with quiet_stdout():  # it prints its build time when first imported
    import pybullet

__all__ = ["pybullet", "quiet_stdout"]
