"""Fog, sky and textures that change, against pixels that can be worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bullet_sim.description import Fog, Material, Plane, SceneDescription, Visual
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.sky import HORIZON, ZENITH

BLACK = Material(diffuse=(0.0, 0.0, 0.0, 1.0), lighting=False)
RED, BLUE = (255, 0, 0), (0, 0, 255)


def wall(distance, material=BLACK, size=200.0):
    return Visual("wall", Plane((-1.0, 0.0, 0.0), (size, size)), Pose((distance, 0.0, 0.0)),
                  material)


def scene_of(*visuals, **description):
    scene = Scene(SceneDescription(**description))
    scene.add_link(("thing", "link"), visuals, Pose())
    return scene


def ahead(pitch=0.0):
    return CameraView(64, 48, 1.0, 0.05, 300.0, Pose.from_xyz_rpy((0, 0, 0), (0.0, pitch, 0.0)))


@pytest.mark.parametrize("fog, share", [
    (Fog("linear", start=2.0, end=12.0), 0.3),
    (Fog("linear", start=6.0, end=12.0), 0.0),
    (Fog("linear", start=1.0, end=4.0), 1.0),
    (Fog("exp", density=0.1), 1 - math.exp(-0.5)),
    (Fog("exp2", density=0.1), 1 - math.exp(-0.25)),
    (Fog("none"), 0.0),
])
def test_fog_hides_by_depth(renderer, fog, share):
    fog = Fog(fog.type, (1.0, 0.5, 0.0, 1.0), fog.start, fog.end, fog.density)
    rgb = renderer.draw(scene_of(wall(5.0), fog=fog), ahead()).rgb
    for pixel in (rgb[24, 32], rgb[0, 0]):  # depth along the axis, the same in the corner
        np.testing.assert_allclose(pixel, np.array([255, 127.5, 0]) * share, atol=1.5)


def test_fog_leaves_the_background_as_it_is(renderer):
    scene = scene_of(fog=Fog("linear", end=2.0), background=(0.0, 0.0, 1.0, 1.0))
    assert (renderer.draw(scene, ahead()).rgb == BLUE).all()


def test_sky_is_behind_everything_and_brighter_below(renderer):
    scene = scene_of(wall(250.0, size=20.0), sky=True)
    view = ahead(-0.2)
    frame = renderer.draw(scene, view, depth=True)
    rows, columns = np.indices((48, 64))
    focal = view.focal_length_px
    rays = np.stack([np.ones((48, 64)), (31.5 - columns) / focal, (23.5 - rows) / focal], -1)
    world = rays @ view.pose.matrix()[:3, :3].T
    height = world[..., 2] / np.linalg.norm(world, axis=-1)
    free = np.isinf(frame.depth)
    assert 0 < np.count_nonzero(~free) < 100 and not frame.rgb[~free].any()
    rise = np.sqrt(np.maximum(height, 0.0))[..., None]
    expected = (np.array(HORIZON) + (np.array(ZENITH) - HORIZON) * rise) * 255
    np.testing.assert_allclose(frame.rgb[free], expected[free], atol=3)
    up = renderer.draw(scene, ahead(-math.pi / 2)).rgb[24, 32]
    down = renderer.draw(scene, ahead(1.0)).rgb[24, 32]
    np.testing.assert_allclose(up, np.array(ZENITH) * 255, atol=2)
    np.testing.assert_allclose(down, np.array(HORIZON) * 255, atol=1)


def test_sky_comes_through_glass_and_not_without_being_asked_for(renderer):
    pane = wall(5.0, Material(diffuse=(0.0, 0.0, 0.0, 0.5), lighting=False))
    through = renderer.draw(scene_of(pane, sky=True), ahead(1.0)).rgb[24, 32]
    np.testing.assert_allclose(through, np.array(HORIZON) * 127.5, atol=1.5)
    grey = renderer.draw(scene_of(), ahead(-1.0)).rgb[24, 32]
    np.testing.assert_allclose(grey, [178.5] * 3, atol=1)


def test_a_texture_without_a_file_shows_what_the_scene_has_under_its_name(renderer):
    def image(left, right):
        made = np.empty((16, 32, 3), np.uint8)
        made[:, :16], made[:, 16:] = left, right
        return made

    scene = scene_of()
    scene.images["screen"] = image(RED, BLUE)
    screen = wall(1.0, Material(texture="screen", lighting=False), size=1.0)
    scene.add_visual(("thing", "link"), screen)
    before = scene.frozen()
    scene.images["screen"] = image(BLUE, RED)

    def halves(state):
        rgb = renderer.draw(state, ahead()).rgb
        return rgb[34, 32].tolist(), rgb[14, 32].tolist()

    first = halves(before)  # the image's right is up on a plane that faces -x
    assert first == (list(RED), list(BLUE))
    assert halves(scene.frozen()) == first[::-1]
    assert halves(before) == first
