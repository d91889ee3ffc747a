"""The framebuffer for one size of image, and reading it back."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from bullet_sim.rendering import gl_calls
from bullet_sim.rendering.gl_calls import own_array, own_blocks

# In GL_RENDERER of software renderers, perhaps behind another driver.
_SOFTWARE = ("llvm", "softpipe", "swr", "swiftshader", "basic render")
_MOST_SAMPLES = 1 << 26  # in an image; 512 MB of colour and depth
_SAMPLES, _ANISOTROPY = 4, 8.0  # OGRE's usual FSAA in Gazebo; enough for a floor at a flat angle
# px; the coarsest grid that OpenGL allows (SUBPIXEL_BITS of 4). An H200 has one of 1/256: without
# this its ground hid half of the distant course, with 1/256 and more no pixel of 343 million.
_SNAP = 1 / 16


@dataclass(frozen=True)
class Quality:
    """Settings for a graphics card or for software, where samples take ten times as long."""

    samples: int = 0  # per pixel, at edges; 0: no anti-aliasing
    anisotropy: float = 1.0  # of textures
    pixel_buffers: bool = False  # read back without holding Python's GIL
    snap_px: float = 0.0  # error of triangle corners, and thus of the depth of a plane

    def samples_of(self, size: tuple[int, int], depth: bool) -> int:
        """For an image of that size, px; the mean of two depths is the depth of neither."""
        width, height = size
        return 0 if depth or width * height * self.samples > _MOST_SAMPLES else self.samples


def quality_of(context: moderngl.Context) -> Quality:
    """The settings suited to the device."""
    name = context.info["GL_RENDERER"].lower()
    if any(word in name for word in _SOFTWARE):
        return Quality()
    return card_quality(context)


def card_quality(context: moderngl.Context) -> Quality:
    """The settings for a graphics card."""
    return Quality(min(_SAMPLES, context.max_samples), min(_ANISOTROPY, context.max_anisotropy),
                   pixel_buffers=True, snap_px=_SNAP)


class Target:
    """Colour and depth of one size of image. Samples are combined into pixels at the end."""

    def __init__(self, context: moderngl.Context, size: tuple[int, int], samples: int = 0,
                 pixel_buffers: bool = False):
        self._context = context
        with own_blocks():
            self.framebuffer = self._single = _framebuffer(context, size, 0)
            if samples:
                self.framebuffer = _framebuffer(context, size, samples)
        width, height = size
        self._rgba = own_array((height, width, 4))
        reads = 1 if samples else 2  # colour, and perhaps depth
        self._buffers = [context.buffer(reserve=4 * width * height)
                         for _ in range(reads if pixel_buffers else 0)]

    def start(self, background: tuple[float, ...]) -> None:
        """Start an image."""
        self._context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._context.front_face = "cw"  # upside down
        self._context.cull_face = "back"
        self.framebuffer.use()
        self.framebuffer.depth_mask = True
        self.framebuffer.clear(*background[:3], 1.0)

    def blend(self) -> None:
        """From now on surfaces blend with what is there, without writing depth."""
        self._context.enable(moderngl.BLEND)
        self._context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self.framebuffer.depth_mask = False

    def end(self, depth: bool) -> None:
        """Finish drawing; starts reading back."""
        if self.framebuffer is not self._single:
            self._context.copy_framebuffer(self._single, self.framebuffer)
        if self._buffers:
            self._single.read_into(self._buffers[0], components=4, alignment=1)
            if depth:
                self._single.read_into(self._buffers[1], components=1, attachment=-1, alignment=1,
                                       dtype="f4")

    def read(self, depth: bool) -> tuple[np.ndarray, np.ndarray | None]:
        """(h, w, 4) uint8, overwritten by the next image, and raw depth (h, w) if wanted."""
        raw = np.empty(self._rgba.shape[:2], np.float32) if depth else None
        if self._buffers:
            self._buffers[0].read_into(self._rgba)
            if raw is not None:
                self._buffers[1].read_into(raw)
        else:
            self._single.use()
            gl_calls.read_colour(self._rgba)
            if raw is not None:
                gl_calls.read_depth(raw)
        return self._rgba, raw


def _framebuffer(context: moderngl.Context, size: tuple[int, int],
                 samples: int) -> moderngl.Framebuffer:
    return context.framebuffer([context.renderbuffer(size, 4, samples=samples)],
                               context.depth_renderbuffer(size, samples=samples))
