"""Which renderer opens, and that TinyRenderer, when it must, sees what EGL sees."""

from __future__ import annotations

import gc
import logging
import math
import os
import subprocess
import sys
from ctypes.util import find_library

import cv2
import numpy as np
import pytest

from bullet_sim.description import Box, LightDescription, Material, Plane, SceneDescription, Visual
from bullet_sim.errors import SimulationError
from bullet_sim.pose import Pose
from bullet_sim.rendering import renderer as choice
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.tiny import TinyRenderer


@pytest.fixture(autouse=True)
def no_variable(monkeypatch):
    monkeypatch.delenv("BULLET_SIM_RENDERER", raising=False)


@pytest.fixture(scope="module")
def tiny():
    opened = TinyRenderer()
    yield opened
    opened.close()


def broken(_profiler):
    raise OSError("libEGL.so.1 is missing")


def test_egl_comes_first():
    opened = open_renderer()
    assert isinstance(opened, EglRenderer) and opened.name.startswith("EGL, ")
    opened.close()


@pytest.mark.parametrize("by", ["argument", "environment"])
def test_tiny_can_be_asked_for(monkeypatch, by):
    if by == "environment":
        monkeypatch.setenv("BULLET_SIM_RENDERER", "tiny")
    opened = open_renderer("tiny" if by == "argument" else None)
    assert isinstance(opened, TinyRenderer) and "TinyRenderer" in opened.name
    opened.close()


def test_unknown_renderer_names_those_that_exist(monkeypatch):
    monkeypatch.setenv("BULLET_SIM_RENDERER", "vulkan")
    with pytest.raises(SimulationError, match="vulkan: no such renderer; there are: egl, tiny"):
        open_renderer()


def test_without_egl_one_warning_with_reason_and_frame_rate(monkeypatch, caplog):
    monkeypatch.setattr(choice, "_open_egl", broken)
    with caplog.at_level(logging.WARNING, logger="bullet_sim"):
        opened = open_renderer()
    (record,) = caplog.records
    assert isinstance(opened, TinyRenderer)
    assert "libEGL.so.1 is missing" in record.getMessage()
    assert "frames/s at 320x240" in record.getMessage()
    opened.close()


def test_insisting_on_a_broken_egl_is_an_error(monkeypatch):
    monkeypatch.setitem(choice._OPENERS, "egl", broken)
    with pytest.raises(SimulationError, match=r"egl does not start: libEGL\.so\.1 is missing"):
        open_renderer("egl")


@pytest.mark.parametrize("library, name", [
    (find_library("GL"), "EGL, "), ("/nowhere/libGL.so", "TinyRenderer")])
def test_the_opengl_library_may_be_named_or_missing(library, name):
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
                         check=True, env=os.environ | {"GLCONTEXT_LINUX_LIBGL": library})
    assert name in ran.stdout
    assert ("/nowhere/libGL.so: cannot open" in ran.stderr) == (name == "TinyRenderer")


def test_drawing_leaves_nothing_to_the_garbage_collector(no_collector):
    opened, scene = EglRenderer(), Scene().frozen()
    view = CameraView(8, 8, 1.0, 0.05, 50.0, Pose())
    opened.draw(scene, view, depth=True)
    gc.collect()
    opened.draw(scene, view, depth=True)
    assert gc.collect() == 0
    opened.close()


def test_tiny_puts_known_points_where_the_pinhole_says(tiny):
    camera = Pose.from_xyz_rpy((0.3, -0.2, 0.5), (0.05, 0.2, 0.7))
    view = CameraView(320, 240, 1.3439, 0.02, 100.0, camera)
    focal = view.focal_length_px
    scene = Scene(SceneDescription((1.0, 1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 1.0)))
    for column, row, depth in [(159.5, 119.5, 2.0), (20.0, 30.0, 1.0), (300.0, 210.0, 0.5)]:
        size = 11 * depth / focal
        point = (depth, (159.5 - column) * depth / focal, (119.5 - row) * depth / focal)
        lamp = Visual("lamp", Plane((-1.0, 0.0, 0.0), (size, size)), material=Material())
        scene.add_link(("lamp", "link"), [lamp], Pose(camera.transform(point), camera.orientation))
        frame = tiny.draw(scene, view, depth=True)
        scene.remove_model("lamp")
        rows, columns = np.nonzero(frame.rgb[..., 0] > 127)
        assert columns.mean() == pytest.approx(column, abs=0.75)
        assert rows.mean() == pytest.approx(row, abs=0.75)
        assert np.median(frame.depth[rows, columns]) == pytest.approx(depth, rel=5e-3)
        assert np.isinf(frame.depth).sum() == frame.depth.size - len(rows)


def test_tiny_and_egl_draw_the_same_picture(tiny, tmp_path):
    image = np.zeros((64, 64, 3), np.uint8)
    image[:32, :32], image[:32, 32:] = (255, 0, 0), (0, 255, 0)
    image[32:, :32], image[32:, 32:] = (0, 0, 255), (255, 255, 255)
    cv2.imwrite(str(tmp_path / "quarters.png"), image[..., ::-1])
    scene = Scene()
    scene.add_light(LightDescription("sun", "directional", diffuse=(0.8, 0.8, 0.8, 1.0)))
    course = Material(texture=str(tmp_path / "quarters.png"))
    scene.add_link(("course", "link"), [Visual("v", Plane((0, 0, 1), (4.0, 4.0)), material=course)],
                   Pose())
    scene.add_link(("box", "link"), [Visual("v", Box((0.3, 0.3, 0.3)), material=Material())],
                   Pose.from_xyz_rpy((0.3, 0.4, 0.15), (0.0, 0.0, math.pi / 5)))
    view = CameraView(160, 120, 1.0, 0.05, 50.0, Pose.from_xyz_rpy((-3, 0, 1.5), (0, 0.5, 0)))
    egl = EglRenderer()
    expected = egl.draw(scene, view).rgb.astype(int)
    egl.close()
    got = tiny.draw(scene, view).rgb.astype(int)
    off = np.abs(got - expected).max(axis=2) > 40
    assert off.mean() < 0.05


def test_tiny_shows_a_course_at_the_height_of_the_ground(tiny):
    scene = Scene(SceneDescription((1.0, 1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 1.0)))
    for name, size, level in [("ground", 100.0, 0.0), ("course", 4.0, 1.0)]:
        colour = Material(diffuse=(level, level, level, 1.0))
        plane = Visual(name, Plane((0.0, 0.0, 1.0), (size, size)), material=colour)
        scene.add_link((name, "link"), [plane], Pose())
    view = CameraView(320, 240, 1.3439, 0.02, 300.0, Pose((-1.2, 0.0, 0.1)))
    rows = np.arange(240)
    height_per_depth = (rows - 119.5) / view.focal_length_px
    with np.errstate(divide="ignore"):
        x = np.where(height_per_depth > 0, -1.2 + 0.1 / height_per_depth, np.inf)
    seen = tiny.draw(scene, view).rgb[:, 160, 0] > 127
    assert (seen == (x < 2.0)).mean() > 0.98


def test_tiny_follows_the_scene(tiny):
    view = CameraView(64, 48, 1.0, 0.05, 50.0, Pose((-2.0, 0.0, 0.0)))
    scene = Scene()
    scene.add_link(("box", "link"), [Visual("v", Box((0.5, 0.5, 0.5)))], Pose())
    assert tiny.draw(scene, view, depth=True).depth[24, 32] == pytest.approx(1.75, rel=1e-2)
    scene.set_pose(("box", "link"), Pose((1.0, 0.0, 0.0)))
    assert tiny.draw(scene, view, depth=True).depth[24, 32] == pytest.approx(2.75, rel=1e-2)
    scene.remove_model("box")
    frame = tiny.draw(scene, view, depth=True)
    assert np.isinf(frame.depth).all() and (frame.rgb == 179).all()
