"""OpenGL calls that take long: other Python threads run meanwhile. In moderngl's they wait.

Importing it is an OSError where there is no OpenGL library.
"""

import contextlib
import ctypes
import ctypes.util
import math
import mmap
import os
from collections.abc import Iterator

import numpy as np

# The library that glcontext loads, found in the same way.
_GL = ctypes.CDLL(os.environ.get("GLCONTEXT_LINUX_LIBGL") or ctypes.util.find_library("GL")
                  or "libGL.so")
_GL.glFinish.restype = _GL.glReadPixels.restype = None
# With these, an address can be given as an integer; `data_as` would make a cycle each time.
_GL.glReadPixels.argtypes = [*[ctypes.c_int] * 4, ctypes.c_uint, ctypes.c_uint, ctypes.c_void_p]
_RGBA, _UNSIGNED_BYTE = 0x1908, 0x1401
_DEPTH_COMPONENT, _FLOAT = 0x1902, 0x1406


def finish() -> None:
    """Wait until all is drawn."""
    _GL.glFinish()


def read_colour(into: np.ndarray) -> None:
    """Read the framebuffer in use into (h, w, 4) uint8, RGBA."""
    _read(into, _RGBA, _UNSIGNED_BYTE)


def read_depth(into: np.ndarray) -> None:
    """Read the framebuffer in use into (h, w) float32, 0..1."""
    _read(into, _DEPTH_COMPONENT, _FLOAT)


def _read(into: np.ndarray, components: int, kind: int) -> None:
    height, width = into.shape[:2]
    _GL.glReadPixels(0, 0, width, height, components, kind, into.ctypes.data)


# The C library takes blocks of some MB from its heap, if the environment says so, because that is
# fast for short-lived data (see the environment hook of bullet_sim_ros). But freed blocks of
# longer-lived data leave holes there, into which the next ones do not always fit, so memory varies.
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
