"""The renderer opens, or says in one line which packages it needs."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from ctypes.util import find_library

import pytest

from bullet_sim.pose import Pose
from bullet_sim.rendering import egl
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import NoRenderer, open_renderer
from bullet_sim.rendering.scene import Scene

NEEDED = "sudo apt-get install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri"


def test_egl_draws():
    opened = open_renderer()
    assert isinstance(opened, EglRenderer) and opened.name.startswith("EGL, ")
    opened.close()


@pytest.mark.parametrize("error, reason", [
    (OSError("libEGL.so.1\n is missing"), "libEGL.so.1 is missing"), (OSError(), "OSError")])
def test_without_egl_one_line_names_the_reason_and_the_packages(monkeypatch, error, reason):
    def broken():
        raise error

    monkeypatch.setattr(egl, "_open_context", broken)
    with pytest.raises(NoRenderer) as raised:
        open_renderer()
    assert str(raised.value) == (
        f"cameras cannot be drawn: EGL does not start ({reason}); type: {NEEDED}")


@pytest.mark.parametrize("library, opens", [
    (find_library("GL"), True), ("/nowhere/libGL.so", False)])
def test_the_opengl_library_may_be_named_or_missing(library, opens):
    script = (
        "import ctypes.util; find = ctypes.util.find_library;"
        "ctypes.util.find_library = lambda name: None if name == 'GL' else find(name);"
        "from bullet_sim.pose import Pose; from bullet_sim.rendering.frame import CameraView;"
        "from bullet_sim.rendering.renderer import open_renderer;"
        "from bullet_sim.rendering.scene import Scene;"
        "opened = open_renderer(); view = CameraView(8, 8, 1.0, 0.05, 50.0, Pose());"
        "opened.draw(Scene().frozen(), view, depth=True); print(opened.name)"
    )
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True,
                         check=False, env=os.environ | {"GLCONTEXT_LINUX_LIBGL": library})
    assert ran.stdout.startswith("EGL, ") == opens == (ran.returncode == 0)
    assert ("/nowhere/libGL.so: cannot open" in ran.stderr and NEEDED in ran.stderr) != opens


def test_drawing_leaves_nothing_to_the_garbage_collector(no_collector):
    opened, scene = EglRenderer(), Scene().frozen()
    view = CameraView(8, 8, 1.0, 0.05, 50.0, Pose())
    opened.draw(scene, view, depth=True)
    gc.collect()
    opened.draw(scene, view, depth=True)
    assert gc.collect() == 0
    opened.close()
