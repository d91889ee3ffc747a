"""The renderer opens or names packages; what only graphics cards do, on whatever draws here."""

import gc
import math
import os
import subprocess
import sys
from ctypes.util import find_library
from dataclasses import replace

import cv2
import numpy as np
import pytest

from bullet_sim.description import Box, Material, Plane, Visual
from bullet_sim.pose import Pose
from bullet_sim.rendering import egl
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import NoRenderer, open_renderer
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.target import Quality, card_quality

WHITE = Material(diffuse=(1.0, 1.0, 1.0, 1.0), lighting=False)
ROW = 130  # of a picture that ends at 240: 8 m away, where a pixel is 30 times as deep as wide
VIEW = CameraView(320, 240, math.pi / 3, 0.05, 50.0, Pose((-2.0, 0.0, 0.3)))


@pytest.fixture(scope="module")
def plain():
    renderer = EglRenderer(quality=lambda _context: Quality())
    yield renderer
    renderer.close()


@pytest.fixture(scope="module")
def card():
    renderer = EglRenderer(quality=card_quality)
    yield renderer
    renderer.close()


def leaning_box():
    """White before black; its edges are not along rows of pixels."""
    scene = Scene()
    scene.add_link(("box", "link"), (Visual("v", Box((0.8, 0.8, 0.8)), material=WHITE),),
                   Pose.from_xyz_rpy((0.0, 0.0, 0.3), (0.3, 0.0, 0.0)))
    return scene.frozen()


def test_edges_are_smooth_and_all_else_is_the_same(plain, card):
    sharp, smooth = (renderer.draw(leaning_box(), VIEW).rgb for renderer in (plain, card))
    assert len(np.unique(sharp[..., 0])) == 2
    assert len(np.unique(smooth[..., 0])) == 5  # none to four of four samples
    near_edges = cv2.dilate(cv2.Canny(sharp, 50, 100), np.ones((3, 3))) > 0
    assert np.array_equal(sharp[~near_edges], smooth[~near_edges])
    assert not np.array_equal(sharp, smooth)


def test_a_picture_with_depth_is_as_in_software(plain, card):
    there, here = (renderer.draw(leaning_box(), VIEW, depth=True) for renderer in (plain, card))
    assert np.array_equal(there.rgb, here.rgb)
    assert np.array_equal(there.depth, here.depth)


def test_equal_scenes_give_equal_bits(card):
    first = card.draw(leaning_box(), VIEW).rgb
    card.draw(leaning_box(), VIEW, depth=True)
    assert np.array_equal(first, card.draw(leaning_box(), VIEW).rgb)


def test_corners_on_a_grid_do_not_hide_a_course_on_the_ground(plain, card):
    """The grid of a card is 1/16 px or finer; the ground is lifted by less, f_px * LIFT / distance.

    So by up to 0.047 px in the lowest row, 240 px below the horizon.
    """
    lift, height = 2e-5, 0.1
    view = replace(VIEW, width=640, height=480, near=0.02, pose=Pose((0.0, 0.0, height)))
    black = replace(WHITE, ambient=(0.0, 0.0, 0.0, 1.0), diffuse=(0.0, 0.0, 0.0, 1.0))
    course, scene = Scene(), Scene()
    white = Visual("v", Plane((0.0, 0.0, 1.0), (4.0, 4.0)), material=WHITE)
    for one in (course, scene):
        one.add_link(("course", "link"), (white,), Pose())
    ground = Visual("v", Plane((0.0, 0.0, 1.0), (100.0, 100.0)), material=black)
    scene.add_link(("ground", "link"), (ground,), Pose((0.0, 0.0, lift)))
    for depth in (False, True):
        wanted = card.draw(course.frozen(), view, depth).rgb[240:] == 255
        assert wanted.sum() > 300_000
        assert np.array_equal(card.draw(scene.frozen(), view, depth).rgb[240:] == 255, wanted)
    assert not np.array_equal(plain.draw(scene.frozen(), view).rgb[240:] == 255, wanted)


def test_stripes_on_a_floor_are_seen_farther_away(tmp_path, plain, card):
    stripes = np.zeros((256, 256, 3), np.uint8)
    for first in range(4):
        stripes[first::16] = 255
    cv2.imwrite(str(tmp_path / "stripes.png"), stripes)
    floor = Material(lighting=False, texture=str(tmp_path / "stripes.png"))
    scene = Scene()
    scene.add_link(("floor", "link"), (
        Visual("v", Plane((0.0, 0.0, 1.0), (20.0, 20.0)), material=floor),), Pose())
    contrast = [float(renderer.draw(scene.frozen(), VIEW).rgb[ROW, :, 0].std())
                for renderer in (plain, card)]
    assert contrast[1] > 1.5 * contrast[0]


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
