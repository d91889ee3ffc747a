"""What a renderer drew in, and what it keeps ready to draw, goes when it is told so."""

import ctypes
import math
import os
import subprocess
import sys
import weakref
from dataclasses import replace
from pathlib import Path

import pytest

from bullet_sim.description import Box, Visual
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.target import Quality

SIDE = 1024  # px
PICTURE = SIDE * SIDE * (4 + 4)  # bytes of colour and depth
VIEW = CameraView(SIDE, SIDE, math.pi / 3, 0.05, 50.0, Pose((-2.0, 0.0, 0.0)))


class MallocInfo(ctypes.Structure):
    """The C library's `struct mallinfo2`."""

    _fields_ = [(name, ctypes.c_size_t) for name in (
        "arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks",
        "fordblks", "keepcost")]


def blocks():
    """Bytes that the process (llvmpipe, too) has asked the C library for: in the heap, outside."""
    function = ctypes.CDLL(None).mallinfo2
    function.restype = MallocInfo
    info = function()
    return info.uordblks, info.hblkhd


def allocated():
    return sum(blocks())


@pytest.fixture
def renderer():
    opened = open_renderer()
    yield opened
    opened.close()


@pytest.fixture
def scene():
    made = Scene()
    made.add_link(("robot", "link"), (Visual("v", Box((1.0, 1.0, 1.0))),), Pose())
    return made


def test_the_driver_lets_go_of_the_last_picture(renderer, scene):
    renderer.draw(scene.frozen(), replace(VIEW, width=8, height=8))  # what stays is there now
    before = allocated()
    first = renderer.draw(scene.frozen(), VIEW).rgb
    *_, target = renderer._targets.values()
    framebuffer = weakref.ref(target.framebuffer)
    del target
    renderer.trim()
    assert framebuffer() is None
    assert allocated() - before < first.nbytes + PICTURE / 4
    assert (renderer.draw(scene.frozen(), VIEW).rgb == first).all()  # it goes on


def test_what_is_drawn_in_leaves_no_holes_in_the_heap(renderer):
    if renderer._quality != Quality():
        pytest.skip("the driver of a graphics card has memory of its own")
    script = (
        "from test_renderer_memory import *; opened = open_renderer();"
        "before = blocks()[0]; opened.draw(Scene().frozen(), VIEW); after = blocks()[0];"
        "assert after - before < PICTURE / 4, (before, after);"
        "import numpy; piece = numpy.empty(8 << 20, numpy.uint8);"
        "assert blocks()[0] - after >= 8 << 20"  # for others all is as it was
    )
    environment = os.environ | {"MALLOC_MMAP_THRESHOLD_": "33554432"}
    subprocess.run([sys.executable, "-c", script], check=True, env=environment,
                   cwd=Path(__file__).parent)


def test_models_that_have_gone_are_not_kept_ready(renderer, scene):
    renderer.draw(scene.frozen(), VIEW)
    (surface,) = renderer._store.of(scene.nodes["robot", "link"].shape)
    gone = weakref.ref(surface), weakref.ref(surface.triangles.vertices)
    del surface
    scene.remove_model("robot")
    assert gone[0]() is not None
    renderer.trim()
    assert [reference() for reference in gone] == [None, None]
    assert not renderer._context.objects  # nor does anything wait to be released
