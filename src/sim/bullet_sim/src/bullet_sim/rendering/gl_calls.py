"""OpenGL calls that take long: other Python threads run meanwhile. In moderngl's they wait."""

import ctypes
import ctypes.util

import numpy as np

_GL = ctypes.CDLL(ctypes.util.find_library("GL"))  # glcontext loads the same
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
    _GL.glReadPixels(0, 0, width, height, components, kind,
                     into.ctypes.data_as(ctypes.c_void_p))
