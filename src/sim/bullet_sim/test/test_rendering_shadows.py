"""Shadows in pictures against what the geometry says, and that they cost nothing where none are."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np
import pytest

from bullet_sim.description import (
    Box,
    Cylinder,
    Fog,
    LightDescription,
    Material,
    Plane,
    SceneDescription,
    Sphere,
    Visual,
)
from bullet_sim.pose import Pose
from bullet_sim.rendering import shadows
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.shadows import Shadows

DARK = SceneDescription(ambient=(0.0, 0.0, 0.0, 1.0), background=(0.0, 0.0, 0.0, 1.0))
# Straight down, top of the picture towards +y, right towards +x.
DOWN = (0.5, -0.5, -0.5, -0.5)
GLOSSY = Material(specular=(0.1, 0.1, 0.1, 1.0), shininess=9.0)  # lit per pixel
BOX = ("box", "link")


def sun(direction=(0.5, 0.2, -1.0), name="sun", level=1.0, **kwargs):
    given = {"specular": (0.0, 0.0, 0.0, 1.0), "cast_shadows": True} | kwargs
    return LightDescription(name, "directional", diffuse=(level, level, level, 1.0),
                            direction=direction, **given)


def spot(at, towards=(0.0, 0.0, -1.0), **kwargs):
    given = {"inner_angle": 1.2, "outer_angle": 1.4, "range": 8.0, "linear": 0.0,
             "cast_shadows": True, "specular": (0.0, 0.0, 0.0, 1.0)} | kwargs
    return LightDescription("spot", "spot", Pose(at), direction=towards, **given)


def floor(material=Material(), size=100.0, **kwargs):
    return Visual("floor", Plane((0.0, 0.0, 1.0), (size, size)), material=material,
                  **({"cast_shadows": False} | kwargs))


def stage(*lights, box=Visual("box", Box((1.0, 0.6, 0.8))), ground=floor(), at=Pose((0, 0, 0.4)),
          description=DARK):
    """A floor with a box on it."""
    scene = Scene(description)
    for light in lights or [sun()]:
        scene.add_light(light)
    scene.add_link(("ground", "link"), [ground], Pose())
    scene.add_link(BOX, [box], at)
    return scene


def from_above(at=(0.6, 0.3, 4.0)):
    return CameraView(640, 480, 1.0, 0.05, 50.0, Pose(at, DOWN))


def slanting():
    return CameraView(640, 480, 1.0, 0.05, 50.0, Pose.from_xyz_rpy((-2, -1.5, 2), (0, 0.65, 0.55)))


def floor_in_view(view):
    """(h, w, 3) the floor's point, in the world, in the middle of each pixel."""
    columns, rows = np.meshgrid(np.arange(view.width), np.arange(view.height))
    focal = view.focal_length_px
    rays = np.stack([np.ones_like(columns, float), ((view.width - 1) / 2 - columns) / focal,
                     ((view.height - 1) / 2 - rows) / focal], -1) @ view.pose.matrix()[:3, :3].T
    return view.pose.position - view.pose.position[2] * rays / rays[..., 2:]


def hidden_by_box(points, towards, size, pose):
    """Which points (..., 3) see the box when they look along `towards`."""
    matrix = pose.inverse().matrix()
    points = points @ matrix[:3, :3].T + matrix[:3, 3]
    towards = towards @ matrix[:3, :3].T
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([-points - np.array(size) / 2, np.array(size) / 2 - points]) / towards
    enter, leave = both.min(axis=0).max(axis=-1), both.max(axis=0).min(axis=-1)
    return (enter < leave) & (leave > 0)


def within(mask, steps):
    """The mask widened by so many pixels."""
    for _ in range(steps):
        around = np.pad(mask, 1)
        mask = mask | around[2:, 1:-1] | around[:-2, 1:-1] | around[1:-1, 2:] | around[1:-1, :-2]
    return mask


@pytest.mark.parametrize("view", [from_above(), slanting()])
@pytest.mark.parametrize("material", [Material(), GLOSSY])
@pytest.mark.parametrize("pose, direction", [
    (Pose((0, 0, 0.4)), (-0.5, -0.4, -0.8)),
    (Pose((0, 0, 0.4)), (-1.0, 0.7, -0.7)),
    (Pose.from_xyz_rpy((0.2, 0.1, 0.9), (0.5, 0.3, 0.8)), (0.3, 0.1, -1.0)),
    (Pose.from_xyz_rpy((-0.5, 0, 0.9), (0.0, 0.3, 0.2)), (0.0, 0.0, -1.0)),
])
def test_a_box_darkens_the_floor_where_it_hides_the_sun(renderer, view, material, pose, direction):
    scene = stage(sun(direction), ground=floor(material), at=pose)
    level = renderer.draw(scene, view).rgb[..., 0].astype(int)
    points, towards = floor_in_view(view), -np.array(direction)
    box = hidden_by_box(points, np.array(view.pose.position) - points, (1.0, 0.6, 0.8), pose)
    dark = hidden_by_box(points, towards, (1.0, 0.6, 0.8), pose)
    free = ~within(box, 2)
    full = 255 * towards[2] / np.linalg.norm(towards)
    assert np.count_nonzero(dark & free) > 1000
    assert (level[free & ~within(~dark, 1)] == 0).all()
    assert np.abs(level[free & ~within(dark, 1)] - full).max() <= 2


@pytest.mark.parametrize("at, towards", [
    ((0.0, 0.0, 3.0), (0.0, 0.0, -1.0)), ((-1.0, 0.8, 2.5), (0.5, -0.3, -1.0))])
def test_a_box_darkens_the_floor_where_it_hides_a_spot_light(renderer, at, towards):
    scene, view = stage(spot(at, towards)), from_above((0.6, 0.3, 6.0))
    scene.set_pose(BOX, Pose((0.0, 0.0, 0.6)))
    level = renderer.draw(scene, view).rgb[..., 0].astype(int)
    points = floor_in_view(view)
    size, pose = (1.0, 0.6, 0.8), Pose((0.0, 0.0, 0.6))
    box = hidden_by_box(points, np.array(view.pose.position) - points, size, pose)
    gap = np.array(at) - points
    dark = hidden_by_box(points, gap, size, pose)
    gap /= np.linalg.norm(gap, axis=-1, keepdims=True)
    lit = -gap @ np.array(towards) / np.linalg.norm(towards) > np.cos(0.58)
    free = ~within(box, 2) & lit
    assert np.count_nonzero(dark & free) > 1000
    assert (level[free & ~within(~dark, 1)] == 0).all()
    bright = free & ~within(dark, 1)
    assert np.abs(level - 255 * gap[..., 2])[bright].max() <= 2


def test_what_lies_before_a_wide_spot_light_darkens_nothing_behind_it(renderer):
    scene = stage(spot((0, 0, 3), (0.0, 0.0, 1.0), outer_angle=5.0, inner_angle=4.5, range=50.0))
    wall = Visual("wall", Box((0.1, 6.0, 10.0)), cast_shadows=False)
    scene.add_link(("wall", "link"), [wall], Pose((-2.0, 0.0, 5.0)))
    view = CameraView(320, 240, 1.0, 0.05, 50.0, Pose.from_xyz_rpy((5, 0, 2), (0, 0, np.pi)))
    bare = renderer.draw(scene, view).rgb
    scene.add_link(("roof", "link"), [Visual("roof", Box((1.0, 1.0, 0.1)))], Pose((3.0, 0.0, 6.0)))
    assert np.array_equal(renderer.draw(scene, view).rgb, bare)  # nor is the roof in the picture


@pytest.mark.parametrize("direction", [(0.0, 0.0, 0.0), (1e200, 1e200, 0.0)])
def test_a_sun_without_a_direction_of_a_length_shines_down(renderer, direction):
    wanted = renderer.draw(stage(sun((0.0, 0.0, -1.0))), slanting()).rgb
    assert np.array_equal(renderer.draw(stage(sun(direction)), slanting()).rgb, wanted)


@pytest.mark.parametrize("changed", [
    lambda: stage(replace(spot((0, 0, 3)), outer_angle=0.0)),
    lambda: stage(description=replace(DARK, shadows=False)),
    lambda: stage(sun(cast_shadows=False)),
    lambda: stage(box=Visual("box", Box((1.0, 0.6, 0.8)), cast_shadows=False)),
    lambda: stage(replace(sun(), type="point", pose=Pose((0, 0, 9)), range=99.0)),
])
def test_nothing_is_drawn_otherwise_where_nothing_casts(renderer, changed, monkeypatch):
    scene = changed()
    picture = renderer.draw(scene, slanting()).rgb
    bare = Scene(scene.description)
    for light in scene.lights.values():
        bare.add_light(replace(light, cast_shadows=False))
    for key, visuals in scene.visuals.items():
        bare.add_link(key, [replace(one, cast_shadows=False) for one in visuals],
                      scene.nodes[key].pose)
    monkeypatch.setattr(Shadows, "use", None)
    assert np.array_equal(renderer.draw(bare, slanting()).rgb, picture)


def test_glass_casts_no_shadow_and_takes_one(renderer):
    pane = Visual("pane", Box((1.0, 0.6, 0.8)), transparency=0.5)
    bright = renderer.draw(stage(sun(level=0.5), box=pane), from_above((0.9, 0.1, 4.0))).rgb
    assert bright[240, 320, 0] > 100
    under = stage(ground=floor(transparency=0.5), description=replace(
        DARK, background=(1.0, 1.0, 1.0, 1.0)))
    picture = renderer.draw(under, from_above((0.65, 0.1, 4.0))).rgb
    np.testing.assert_allclose(picture[240, 320], 127.5, atol=1)
    assert picture[240, 20, 0] > 200


def test_a_shadow_takes_a_light_and_leaves_the_others(renderer):
    lit = Material(ambient=(0.2, 0.2, 0.2, 1.0), emissive=(0.1, 0.1, 0.1, 1.0))
    scene = stage(sun(level=0.3), sun((0.0, 0.0, -1.0), "noon", 0.4, cast_shadows=False),
                  ground=floor(lit), description=replace(DARK, ambient=(1.0, 1.0, 1.0, 1.0)))
    picture = renderer.draw(scene, from_above((0.65, 0.1, 4.0))).rgb
    np.testing.assert_allclose(picture[240, 320], 255 * (0.2 + 0.1 + 0.4), atol=1)


def test_two_suns_cast_two_shadows(renderer):
    scene = stage(sun((0.5, 0.0, -1.0), level=0.5), sun((-0.5, 0.0, -1.0), "other", 0.25))
    picture = renderer.draw(scene, from_above((0.0, 0.0, 4.0))).rgb
    slope, focal = 1 / np.sqrt(1.25), from_above().focal_length_px
    for x, level in ((0.7, 0.25), (-0.7, 0.5), (1.3, 0.75)):
        found = picture[240, round(319.5 + focal * x / 4.0), 0]
        np.testing.assert_allclose(found, 255 * slope * level, atol=1)


@pytest.mark.parametrize("shape", [
    Box((1.0, 0.6, 0.8)), Sphere(0.5), Cylinder(0.3, 0.8), Plane((0.0, 0.0, 1.0), (1.0, 1.0))])
@pytest.mark.parametrize("material", [Material(), GLOSSY])
def test_what_sees_the_sun_has_no_stripes_of_its_own_shadow(renderer, shape, material):
    def picture(shadows, light):
        scene = Scene(replace(DARK, shadows=shadows))
        scene.add_light(light)
        scene.add_link(BOX, [Visual("v", shape, material=material)],
                       Pose.from_xyz_rpy((0, 0, 0.5), (0.2, -0.3, 0.1)))
        return renderer.draw(scene, slanting()).rgb.astype(int)

    for light in (sun((0.5, 0.2, -1.0)), sun((1.0, 0.9, -0.3)), sun((0.3, 1.0, -0.1)),
                  spot((-0.5, 0.3, 2.5)), spot((-2.0, -0.5, 1.0), (0.8, 0.1, 0.2))):
        plain = picture(False, light)
        facing = plain[..., 0] > 40  # not the last facets before the shade
        assert np.count_nonzero(facing) > 1000
        assert np.abs(picture(True, light) - plain)[facing].max() <= 1


@pytest.fixture
def drawn(monkeypatch):
    """What changed, each time that maps are drawn."""
    found, draw = [], Shadows._draw
    monkeypatch.setattr(Shadows, "_draw",
                        lambda self, changed: found.append(changed) or draw(self, changed))
    return found


def test_a_shadow_moves_with_the_box_and_its_map_waits_for_that(renderer, drawn):
    scene = stage()
    first = renderer.draw(scene, from_above()).rgb
    renderer.draw(scene, slanting())
    assert np.array_equal(renderer.draw(scene, from_above()).rgb, first) and len(drawn) == 1
    scene.set_pose(BOX, Pose((0.5, 0, 0.4)))
    assert not np.array_equal(renderer.draw(scene, from_above()).rgb, first) and len(drawn) == 2
    renderer.draw(scene, from_above((20.0, 0.0, 4.0)))  # no shadow there
    scene.set_pose(BOX, Pose((0.6, 0, 0.4)))
    renderer.draw(scene, from_above((20.0, 0.0, 4.0)))
    assert len(drawn) == 2
    scene.set_pose(BOX, Pose((0, 0, 0.4)))
    assert np.array_equal(renderer.draw(scene, from_above()).rgb, first)
    renderer.trim()
    assert np.array_equal(renderer.draw(scene, from_above()).rgb, first)


def test_cameras_that_look_elsewhere_leave_each_other_the_map(renderer, drawn):
    scene = stage()
    scene.add_link(("far", "link"), [Visual("box", Box((0.2, 0.2, 0.2)))], Pose((1.8, 1.8, 0.1)))
    views = from_above((0.0, 0.0, 1.2)), from_above((1.8, 1.8, 0.8))
    pictures = [renderer.draw(scene, view).rgb for view in views]
    assert len(drawn) == 2
    for view, picture in 2 * list(zip(views, pictures)):
        assert np.array_equal(renderer.draw(scene, view).rgb, picture)
    assert len(drawn) == 2


@pytest.mark.parametrize("pose", [Pose((np.nan, 0.0, 0.0)), Pose((0.0, 0.0, np.inf)),
                                  Pose((0.0, 0.0, 0.4), (0.0, 0.0, np.nan, 1.0))])
@pytest.mark.parametrize("light", [sun(), spot((0.5, 0.4, 3.0))])
def test_what_is_nowhere_for_a_moment_stays_in_the_picture(renderer, light, pose):
    scene = stage(light)
    first = renderer.draw(scene, slanting()).rgb
    scene.set_pose(BOX, pose)
    assert np.array_equal(renderer.draw(scene, slanting()).rgb, first)


def crowd(seed):
    """Things of all kinds in shadow of one another, and a view of them."""
    random = np.random.default_rng(seed)
    scene = stage(sun(tuple(random.uniform((-1, -1, -1), (1, 1, -0.1)))),
                  sun(tuple(random.uniform(-1, 1, 3)), "other", 0.5),
                  spot(tuple(random.uniform((-3, -3, 1), (3, 3, 4)))),
                  ground=floor((Material(), GLOSSY)[seed % 2]),
                  description=SceneDescription(fog=Fog("linear") if seed % 3 == 0 else Fog()))
    shapes = [Box((0.5, 0.3, 0.9)), Sphere(0.3), Cylinder(0.2, 0.6),
              Plane((0.0, 1.0, 0.3), (3.0, 1.0))]
    for number in range(8):
        pose = Pose.from_xyz_rpy(random.uniform((-3, -3, 0), (3, 3, 1.5)), random.uniform(-3, 3, 3))
        scene.add_link((f"thing{number}", "link"), [
            Visual("v", shapes[number % 4], transparency=0.4 * (number % 5 == 0))], pose)
    return scene, CameraView(320, 240, 1.2, 0.05, 50.0, Pose.from_xyz_rpy(
        random.uniform((-3, -3, 0.1), (3, 3, 2)), random.uniform((0, -0.3, -3), (0, 0.8, 3))))


@pytest.mark.parametrize("seed", range(24))
def test_what_is_left_out_for_speed_is_not_missed(renderer, monkeypatch, seed):
    scene, view = crowd(seed)
    quick = renderer.draw(scene, view).rgb.astype(int)
    monkeypatch.setattr(shadows, "shadow_places", everywhere)
    whole = renderer.draw(scene, view).rgb.astype(int)
    assert np.abs(whole - quick).max() <= 1  # one rounds in the corner, one in the pixel


def everywhere(reach, casters, in_map, receivers, clip_world):
    """As `shadow_places`, with nothing left out."""
    one, other = np.indices((len(casters), len(receivers))).reshape(2, -1)
    return one, other, np.tile([[-1.0, -1.0], [1.0, 1.0]], (len(one), 1, 1))


def test_the_same_scene_gives_the_same_bytes(renderer):
    scene, view = crowd(1)
    other = EglRenderer()
    pictures = [drawing.draw(state, view).rgb
                for drawing, state in ((renderer, scene), (renderer, crowd(1)[0]),
                                       (other, crowd(1)[0]), (other, scene.frozen()))]
    other.close()
    assert all(np.array_equal(pictures[0], one) for one in pictures[1:])


@pytest.mark.parametrize("seed", range(3))
def test_a_picture_knows_nothing_of_what_was_drawn_before(renderer, seed):
    scene, view = crowd(seed)
    poses = {key: node.pose for key, node in scene.nodes.items()}
    random = np.random.default_rng(seed)
    for _ in range(4):
        for key in list(poses)[2::3]:
            scene.set_pose(key, Pose(random.uniform((-3, -3, 0), (3, 3, 1.5))))
        renderer.draw(scene, replace(view, pose=crowd(random.integers(99))[1].pose))
    for key, pose in poses.items():
        scene.set_pose(key, pose)
    other = EglRenderer()
    fresh = other.draw(crowd(seed)[0], view).rgb
    other.close()
    assert np.array_equal(renderer.draw(scene, view).rgb, fresh)


def test_what_moves_out_of_sight_is_not_drawn_into_maps(renderer, drawn):
    scene, far = stage(), ("far", "link")
    scene.add_link(far, [Visual("box", Box((0.2, 0.2, 0.2)))], Pose((9.0, 9.0, 0.1)))
    scene.add_link(("end", "link"), [Visual("box", Box((0.2, 0.2, 0.2)))], Pose((9.5, 9.5, 0.1)))
    first = renderer.draw(scene, from_above()).rgb
    for step in range(3):
        scene.set_pose(far, Pose((8.0 + 0.1 * step, 9.0, 0.1)))
        assert np.array_equal(renderer.draw(scene, from_above()).rgb, first)
    assert len(drawn) == 1
    scene.set_pose(far, Pose((0.6, 0.9, 0.1)))
    assert not np.array_equal(renderer.draw(scene, from_above()).rgb, first)
    assert [changed.tolist() for changed in drawn[1:]] == [[False, True, False]]


def test_lights_beyond_the_fourth_cast_none_and_say_so(renderer, caplog):
    suns = [sun(name=f"sun{number}", level=0.1) for number in range(6)]
    with caplog.at_level(logging.WARNING, logger="bullet_sim"):
        scene = stage(*suns)
        picture = renderer.draw(scene, from_above((0.65, 0.1, 4.0))).rgb
        scene.change_light(suns[0])  # it stays the first
        assert np.array_equal(renderer.draw(scene, from_above((0.65, 0.1, 4.0))).rgb, picture)
    assert caplog.messages == ["more than 4 lights cast shadows; these do not: sun4, sun5"]
    slope = 1 / np.linalg.norm((0.5, 0.2, 1.0))
    np.testing.assert_allclose(picture[240, 320], 255 * 0.2 * slope, atol=1)
