"""The EGL renderer against pictures whose pixels can be worked out by hand."""

from __future__ import annotations

import gc
import itertools
import logging
import math
import threading

import cv2
import numpy as np
import pytest

from bullet_sim.description import (
    Box,
    LightDescription,
    Material,
    Plane,
    SceneDescription,
    Sphere,
    Visual,
)
from bullet_sim.pose import Pose
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.scene import Scene

HFOV = 1.3439
UP = (0.0, 0.0, 1.0)
DARK = SceneDescription(ambient=(0.0, 0.0, 0.0, 1.0), background=(0.0, 0.0, 0.0, 1.0))
LAMP = Material(diffuse=(1.0, 1.0, 1.0, 1.0), lighting=False)
# Straight down, top of the picture towards +y, right towards +x.
DOWN = (0.5, -0.5, -0.5, -0.5)


def sun(direction=(0.0, 0.0, -1.0), level=0.8, **kwargs):
    return LightDescription(
        "sun", type="directional", diffuse=(level, level, level, 1.0), direction=direction, **kwargs
    )


def floor(material, size=(4.0, 4.0), **kwargs):
    return Visual("floor", Plane(UP, size), material=material, **kwargs)


def scene_of(*visuals, light=None, description=SceneDescription()):
    scene = Scene(description)
    if light is not None:
        scene.add_light(light)
    scene.add_link(("thing", "link"), visuals, Pose())
    return scene


def from_above(width=64, height=64, at=2.0):
    return CameraView(width, height, 1.0, 0.05, 50.0, Pose((0.0, 0.0, at), DOWN))


def middle(frame):
    height, width = frame.rgb.shape[:2]
    return frame.rgb[height // 2, width // 2].tolist()


def test_known_points_fall_where_the_pinhole_says(renderer):
    camera = Pose.from_xyz_rpy((0.3, -0.2, 0.5), (0.05, 0.2, 0.7))
    view = CameraView(1920, 1080, HFOV, 0.02, 100.0, camera)
    focal = 1920 / (2 * math.tan(HFOV / 2))
    scene = Scene(DARK)
    errors_px = []
    points = [
        (959, 539, 2.0), (40, 30, 1.0), (1880, 25, 3.0), (30, 1050, 5.0),
        (1890, 1040, 0.5), (300, 700, 1.5), (1333, 200, 8.0), (960, 900, 0.1),
    ]
    steps = (0.0, 0.25, 0.5, 0.75)  # a square covers whole pixels: its parts show in the mean
    for (left, top, depth), step in itertools.product(points, steps):
        column, row = left + step + 0.1, top + step + 0.1
        point = (depth, (959.5 - column) * depth / focal, (539.5 - row) * depth / focal)
        size = 15 * depth / focal  # a square of 15 px that faces the camera
        lamp = Visual("lamp", Plane((-1.0, 0.0, 0.0), (size, size)), material=LAMP)
        scene.add_link(("lamp", "link"), [lamp], Pose(camera.transform(point), camera.orientation))
        rows, columns = np.nonzero(renderer.draw(scene, view).rgb[..., 0] > 127)
        scene.remove_model("lamp")
        assert 13 * 13 <= len(rows) <= 17 * 17
        errors_px.append((columns.mean() - column, rows.mean() - row))
    mean_errors_px = np.reshape(errors_px, (len(points), len(steps), 2)).mean(axis=1)
    assert np.abs(mean_errors_px).max() < 0.2


def test_depth_of_a_floor_is_the_closed_form_and_nothing_beyond_it(renderer):
    camera = Pose.from_xyz_rpy((0.0, 0.0, 0.5), (0.0, 0.3, 0.4))
    view = CameraView(320, 240, 1.047, 0.02, 100.0, camera)
    frame = renderer.draw(scene_of(floor(None, (1000.0, 1000.0))), view, depth=True)
    focal = view.focal_length_px
    columns, rows = np.meshgrid(np.arange(320), np.arange(240))
    rays = np.stack([np.ones_like(columns), (159.5 - columns) / focal, (119.5 - rows) / focal], -1)
    down = -(rays @ camera.matrix()[:3, :3].T)[..., 2]
    with np.errstate(divide="ignore"):
        expected = np.where(down > 0, 0.5 / down, np.inf)
    expected[expected > 100.0] = np.inf
    near = expected < 50
    assert near.sum() > 30_000 and np.isinf(expected).sum() > 10_000
    np.testing.assert_allclose(frame.depth[near], expected[near], rtol=1e-3)
    assert np.isinf(frame.depth[expected == np.inf]).mean() > 0.99  # but for the row at `far`
    assert frame.depth.dtype == np.float32 and frame.depth.shape == (240, 320)


@pytest.mark.parametrize(("direction", "expected"), [
    ((0.0, 0.0, -1.0), (102, 153, 255)),
    ((math.sqrt(3) / 2, 0.0, -0.5), (76.5, 102, 153)),
    ((0.0, 0.0, 1.0), (51, 51, 51)),
])
def test_lambert_and_ambient(renderer, direction, expected):
    material = Material(ambient=(0.5, 0.5, 0.5, 1.0), diffuse=(0.25, 0.5, 1.0, 1.0))
    frame = renderer.draw(scene_of(floor(material), light=sun(direction)), from_above())
    np.testing.assert_allclose(middle(frame), expected, atol=1)


def test_emission_adds_and_light_clamps(renderer):
    glowing = Material(ambient=(0.0, 0.0, 0.0, 1.0), diffuse=(0.0, 1.0, 0.0, 1.0),
                       emissive=(0.5, 0.5, 0.0, 1.0))
    frame = renderer.draw(scene_of(floor(glowing), light=sun()), from_above())
    np.testing.assert_allclose(middle(frame), (127.5, 255, 0), atol=1)


def test_highlight_where_the_sun_mirrors(renderer):
    black = (0.0, 0.0, 0.0, 1.0)
    shiny = Material(black, black, specular=(0.5, 1.0, 0.0, 1.0), shininess=50.0)
    light = sun(specular=(0.4, 0.4, 0.4, 1.0))
    frame = renderer.draw(scene_of(floor(shiny), light=light, description=DARK), from_above())
    np.testing.assert_allclose(middle(frame), (51, 102, 0), atol=1)
    assert frame.rgb[0, 0].max() < 10


@pytest.mark.parametrize(("changes", "expected"), [
    ({"type": "point"}, 255 / 3),
    ({"type": "point", "range": 1.9}, 0),
    ({"type": "spot", "inner_angle": 0.5, "outer_angle": 1.0, "falloff": 1.0}, 255 / 3),
    ({"type": "spot", "inner_angle": 0.5, "outer_angle": 1.0, "direction": (0.0, 1.0, -1.0)}, 0),
])
def test_near_lights_fade_and_end(renderer, changes, expected):
    settings = {"pose": Pose((0.0, 0.0, 2.0)), "linear": 0.5, "quadratic": 0.25} | changes
    lamp = LightDescription("lamp", **settings)
    frame = renderer.draw(scene_of(floor(Material()), light=lamp, description=DARK), from_above())
    np.testing.assert_allclose(middle(frame), [expected] * 3, atol=1)


@pytest.fixture
def quarters(tmp_path):
    """An image of red | green over blue | white."""
    image = np.zeros((64, 64, 3), np.uint8)
    image[:32, :32], image[:32, 32:] = (255, 0, 0), (0, 255, 0)
    image[32:, :32], image[32:, 32:] = (0, 0, 255), (255, 255, 255)
    path = tmp_path / "quarters.png"
    cv2.imwrite(str(path), image[..., ::-1])
    return str(path)


def test_image_of_a_plane_has_up_at_plus_y_and_right_at_plus_x(renderer, quarters):
    frame = renderer.draw(scene_of(floor(Material(texture=quarters)), light=sun()), from_above())
    corners = [frame.rgb[r, c].tolist() for r, c in [(16, 16), (16, 48), (48, 16), (48, 48)]]
    assert corners == [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]


def test_image_is_upright_on_the_side_of_a_box(renderer, quarters):
    scene = scene_of(Visual("box", Box((1.0, 1.0, 1.0)), material=Material(texture=quarters)),
                     description=SceneDescription(ambient=(1.0, 1.0, 1.0, 1.0)))
    view = CameraView(64, 64, 0.8, 0.1, 10.0, Pose((-2.0, 0.0, 0.0)))
    frame = renderer.draw(scene, view)
    corners = [frame.rgb[r, c].tolist() for r, c in [(16, 16), (16, 48), (48, 16), (48, 48)]]
    assert corners == [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]


def test_texture_scale_of_two_shows_the_middle_twice_as_large(renderer, tmp_path):
    image = np.zeros((64, 64, 3), np.uint8)
    image[16:48, 16:48] = 255
    cv2.imwrite(str(tmp_path / "square.png"), image)
    material = Material(texture=str(tmp_path / "square.png"), texture_scale=(2.0, 2.0))
    frame = renderer.draw(scene_of(floor(material, (8.0, 8.0)), light=sun()), from_above())
    assert (frame.rgb == 255).all()


def test_line_of_a_course_is_yellow_to_the_follower_and_white_is_not(renderer, tmp_path):
    image = np.zeros((512, 512, 3), np.uint8)
    image[:, 100:156], image[:, 356:412] = (255, 255, 0), (255, 255, 255)
    cv2.imwrite(str(tmp_path / "course.png"), image[..., ::-1])
    material = Material(texture=str(tmp_path / "course.png"))
    frame = renderer.draw(
        scene_of(floor(material), light=sun((-0.5, 0.5, -1.0))), from_above(640, 480)
    )
    hsv = cv2.cvtColor(frame.rgb, cv2.COLOR_RGB2HSV)
    mask = cv2.inRange(hsv, (20, 43, 46), (90, 255, 255)) > 0
    assert mask[:, :320].mean() > 0.1 and not mask[:, 320:].any()
    assert (frame.rgb[:, 320:] == 255).all(axis=2).mean() > 0.1


def test_thin_lines_far_away_fade_evenly(renderer, tmp_path):
    image = np.zeros((1024, 1024, 3), np.uint8)
    image[:, ::8] = 255
    cv2.imwrite(str(tmp_path / "lines.png"), image)
    material = Material(texture=str(tmp_path / "lines.png"))
    frame = renderer.draw(scene_of(floor(material), light=sun()), from_above(64, 64, at=3.0))
    assert frame.rgb[8:-8, 8:-8].std() < 3
    assert frame.rgb[8:-8, 8:-8].mean() == pytest.approx(255 / 8, abs=3)


def test_unreadable_texture_is_one_warning_and_a_plain_surface(renderer, tmp_path, caplog):
    (tmp_path / "broken.png").write_bytes(b"no image")
    material = Material(texture=str(tmp_path / "broken.png"))
    with caplog.at_level(logging.WARNING, logger="bullet_sim"):
        for _ in range(2):
            frame = renderer.draw(scene_of(floor(material), light=sun()), from_above())
    assert middle(frame) == [255, 255, 255]
    assert [record.getMessage().count("broken.png") for record in caplog.records] == [1]


@pytest.mark.parametrize("near", [0.02, 0.1])
def test_course_at_the_height_of_the_ground_lies_on_it(renderer, near):
    white = Visual("v", Plane(UP, (4.0, 4.0)), material=LAMP)
    scene = scene_of(floor(Material(ambient=(0.0, 0.0, 0.0, 1.0)), (100.0, 100.0)))
    scene.add_link(("course", "link"), [white], Pose())
    alone = scene_of(white, description=SceneDescription(background=(0.0, 0.0, 0.0, 1.0)))
    for yaw in np.linspace(-3, 3, 9):
        pose = Pose.from_xyz_rpy((0.3, -0.2, 0.1), (0.0, 0.1, yaw))
        view = CameraView(640, 480, HFOV, near, 300.0, pose)
        white_pixels = renderer.draw(alone, view).rgb[..., 0] == 255
        assert np.array_equal(renderer.draw(scene, view).rgb[..., 0] == 255, white_pixels)


def test_background_where_nothing_is(renderer):
    scene = Scene(SceneDescription(background=(0.2, 0.4, 0.6, 1.0)))
    frame = renderer.draw(scene, from_above(), depth=True)
    assert frame.rgb.shape == (64, 64, 3) and (frame.rgb == (51, 102, 153)).all()
    assert np.isinf(frame.depth).all()


def test_glass_mixes_with_what_is_behind_it(renderer):
    red = Material(ambient=(1.0, 0.0, 0.0, 1.0), diffuse=(1.0, 0.0, 0.0, 1.0), lighting=False)
    blue = Material(ambient=(0.0, 0.0, 1.0, 1.0), diffuse=(0.0, 0.0, 1.0, 1.0), lighting=False)
    pane = Visual("pane", Plane(UP, (4.0, 4.0)), Pose((0.0, 0.0, 1.0)), blue, transparency=0.25)
    frame = renderer.draw(scene_of(pane, floor(red)), from_above(), depth=True)
    np.testing.assert_allclose(middle(frame), (64, 0, 191), atol=1)
    assert frame.depth[32, 32] == pytest.approx(2.0, rel=1e-3)


def test_two_panes_mix_from_back_to_front(renderer):
    def pane(name, colour, height):
        material = Material(diffuse=(*colour, 0.5), lighting=False)
        visual = Visual(name, Plane(UP, (1.0, 1.0)), material=material)
        scene.add_link((name, "link"), [visual], Pose((0.0, 0.0, height)))

    scene = Scene(DARK)
    pane("near", (1.0, 0.0, 0.0), 1.0)
    pane("far", (0.0, 1.0, 0.0), 0.2)
    np.testing.assert_allclose(middle(renderer.draw(scene, from_above())), (128, 64, 0), atol=1)


def test_invisible_surface_is_not_drawn(renderer):
    scene = scene_of(floor(LAMP, transparency=1.0), description=DARK)
    assert not renderer.draw(scene, from_above()).rgb.any()


def test_camera_inside_its_housing_sees_out(renderer):
    scene = scene_of(floor(LAMP), Visual("housing", Box((0.4, 0.4, 0.4)), Pose((0.0, 0.0, 2.0))))
    assert middle(renderer.draw(scene, from_above())) == [255, 255, 255]


def test_moved_and_removed_links(renderer):
    scene = scene_of(floor(LAMP, (1.0, 1.0)), description=DARK)
    assert middle(renderer.draw(scene, from_above())) == [255, 255, 255]
    scene.set_pose(("thing", "link"), Pose((100.0, 0.0, 0.0)))
    assert not renderer.draw(scene, from_above()).rgb.any()
    scene.set_pose(("thing", "link"), Pose((0.0, 0.0, -1.0)))
    frame = renderer.draw(scene, from_above(), depth=True)
    assert frame.depth[32, 32] == pytest.approx(3.0, rel=1e-3)
    scene.remove_model("thing")
    assert not renderer.draw(scene, from_above()).rgb.any()


def test_removed_models_leave_nothing_on_the_card(renderer):
    scene = Scene()
    for number in range(5):
        scene.add_link(("ball", "link"), [Visual("v", Sphere(0.1 + number))], Pose())
        renderer.draw(scene, from_above())
        scene.remove_model("ball")
        renderer.draw(scene, from_above())
    gc.collect()
    assert len(renderer._store._surfaces) <= 1


def busy_scene():
    scene = scene_of(floor(None), light=sun((-0.5, 0.5, -1.0)))
    for number in range(8):
        scene.add_link(
            (f"ball{number}", "link"), [Visual("v", Sphere(0.1), transparency=0.5 * (number % 2))],
            Pose((0.2 * number - 0.8, 0.1 * number, 0.1)),
        )
    return scene


def test_same_scene_same_bytes(renderer):
    view = CameraView(640, 480, HFOV, 0.02, 100.0, Pose.from_xyz_rpy((-2, 0, 1), (0, 0.4, 0)))
    first = renderer.draw(busy_scene(), view, depth=True)
    other = EglRenderer()
    for again in (renderer.draw(busy_scene(), view, depth=True),
                  other.draw(busy_scene(), view, depth=True)):
        assert np.array_equal(first.rgb, again.rgb) and np.array_equal(first.depth, again.depth)
    other.close()


def test_frames_are_the_callers_own(renderer):
    lit = scene_of(floor(LAMP))
    first = renderer.draw(lit, from_above())
    kept = first.rgb.copy()
    renderer.draw(Scene(DARK), from_above())
    assert np.array_equal(first.rgb, kept)
    assert first.rgb.flags.c_contiguous and first.rgb.flags.writeable and first.depth is None


def test_any_thread_may_draw(renderer):
    scene = busy_scene()
    expected = renderer.draw(scene, from_above()).rgb
    frames = []
    worker = threading.Thread(target=lambda: frames.append(renderer.draw(scene, from_above())))
    worker.start()
    worker.join(30)
    assert np.array_equal(frames[0].rgb, expected)


def test_lights_beyond_the_eighth_are_left_out_with_a_warning(renderer, caplog):
    scene = scene_of(floor(Material()), description=DARK)
    for number in range(10):
        scene.add_light(LightDescription(f"l{number}", "directional", diffuse=(0.1, 0.1, 0.1, 1.0)))
    with caplog.at_level(logging.WARNING, logger="bullet_sim"):
        frame = renderer.draw(scene, from_above())
    np.testing.assert_allclose(middle(frame), [0.8 * 255] * 3, atol=1)
    assert "l8, l9" in caplog.text
