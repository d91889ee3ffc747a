"""The analytic picture's arithmetic: where rays meet the floor, light, antialiasing, edges."""

import math

import cv2
import numpy as np
import pytest

from bullet_sim.description import (
    LightDescription,
    LinkDescription,
    Material,
    ModelDescription,
    Plane,
    SceneDescription,
    Visual,
    WorldDescription,
)
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from sim_bench import analytic

DOWN = Pose.from_xyz_rpy((0.0, 0.0, 1.0), (0.0, math.pi / 2, 0.0))
AHEAD = Pose.from_xyz_rpy((0.0, 0.0, 1.0))


def view(pose: Pose, width: int = 40, height: int = 30) -> CameraView:
    return CameraView(width, height, math.pi / 2, 0.01, 100.0, pose)


def floor(material: Material, size: float = 2.0, yaw: float = 0.0) -> ModelDescription:
    visual = Visual("visual", Plane((0.0, 0.0, 1.0), (size, size)), material=material)
    link = LinkDescription("link", visuals=(visual,))
    return ModelDescription("floor", Pose.from_xyz_rpy((0, 0, 0), (0, 0, yaw)), True, links=(link,))


def world(*models: ModelDescription, lights: tuple = ()) -> WorldDescription:
    scene = SceneDescription(ambient=(0.5, 0.5, 0.5, 1), background=(0.2, 0.4, 0.6, 1))
    return WorldDescription(scene=scene, models=models, lights=lights)


def texture(path, colours: np.ndarray) -> Material:
    cv2.imwrite(str(path), colours[..., ::-1])
    return Material(ambient=(2.0, 2.0, 2.0, 1), texture=str(path))  # light comes to 1


def test_a_ray_through_a_pixel_meets_the_floor_where_trigonometry_says():
    looking = view(AHEAD)
    x, y, met = analytic.floor_points(looking, np.array([20.0, 30.0]), np.array([25.0, 25.0]))
    assert met.all()
    assert x == pytest.approx([2.0, 2.0])  # 10 px below the middle, focal length 20 px, 1 m high
    assert y == pytest.approx([0.0, -1.0])


def test_the_sky_meets_nothing():
    _, _, met = analytic.floor_points(view(AHEAD), np.array([20.0]), np.array([10.0]))
    assert not met.any()
    picture = analytic.render(world(floor(Material())), view(AHEAD))
    assert picture.rgb[0, 0] == pytest.approx([51, 102, 153])


def test_light_is_ambient_and_the_suns_cosine_and_at_most_1():
    material = Material(ambient=(0.2, 0.2, 1.0, 1), diffuse=(0.5, 1.0, 1.0, 1))
    sun = LightDescription(
        "sun", "directional", diffuse=(0.8, 0.8, 0.8, 1), direction=(0.0, math.sqrt(3), -1.0)
    )
    picture = analytic.render(world(floor(material, 9.0), lights=(sun,)), view(DOWN))
    assert picture.rgb[15, 20] == pytest.approx([255 * 0.3, 255 * 0.5, 255 * 0.9], abs=0.1)
    bright = analytic.render(world(floor(material, 9.0), lights=(sun,) * 5), view(DOWN))
    assert bright.rgb[15, 20, 2] == pytest.approx(255)


def test_the_first_row_of_a_texture_lies_at_plus_y(tmp_path):
    colours = np.zeros((64, 64, 3), np.uint8)
    colours[:32] = (200, 100, 50)
    material = texture(tmp_path / "halves.png", colours)
    (plane,) = analytic.floor_planes(world(floor(material)))
    seen = plane.look_up(plane.texture, np.array([[0.0, 0.0]]), np.array([[0.5, -0.5]]))
    assert seen[0].tolist() == [[200, 100, 50], [0, 0, 0]]
    (turned,) = analytic.floor_planes(world(floor(material, yaw=math.pi)))
    u, v = turned.local(np.array([0.3]), np.array([0.5]))
    assert (u[0], v[0]) == (pytest.approx(-0.3), pytest.approx(-0.5))


def test_stripes_finer_than_a_pixel_are_not_compared(tmp_path):
    colours = np.zeros((512, 512, 3), np.uint8)
    colours[:, ::2] = 200
    picture = analytic.render(
        world(floor(texture(tmp_path / "stripes.png", colours), 9.0)), view(DOWN, 64, 48))
    assert not picture.clear.any()  # a filter may see them otherwise


def test_pixels_near_an_edge_are_not_compared_and_others_are(tmp_path):
    colours = np.zeros((256, 256, 3), np.uint8)
    colours[:, 128:] = 255
    picture = analytic.render(
        world(floor(texture(tmp_path / "halves.png", colours), 9.0)), view(DOWN, 64, 64)
    )
    assert 0.5 < picture.clear.mean() < 1.0
    away = picture.rgb[picture.clear]
    assert np.minimum(away, 255 - away).max() < 1e-3


def test_the_smaller_plane_lies_on_top():
    black = Material(ambient=(0.0, 0.0, 0.0, 1))
    white = Material(ambient=(2.0, 2.0, 2.0, 1))
    picture = analytic.render(world(floor(white, 9.0), floor(black, 0.5)), view(DOWN))
    assert picture.rgb[15, 20] == pytest.approx(0)
    assert picture.rgb[2, 2] == pytest.approx(255)


def test_the_difference_is_the_worst_channels():
    picture = analytic.render(world(), view(AHEAD))
    seen = np.broadcast_to(np.array([51, 105, 153], np.uint8), (30, 40, 3))
    assert analytic.difference(seen, picture) == pytest.approx(3)
