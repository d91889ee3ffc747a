"""Distorted and wide-angle pictures: lamps at known places are seen where the models say."""

from __future__ import annotations

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from bullet_sim.description import (
    CameraDescription,
    Lens,
    LinkDescription,
    Material,
    ModelDescription,
    Noise,
    Plane,
    SceneDescription,
    SensorDescription,
    Sphere,
    Visual,
    WorldDescription,
)
from bullet_sim.errors import FormatError
from bullet_sim.pose import Pose
from bullet_sim.sensors.camera import Camera
from bullet_sim.sensors.image_effects import Distortion
from bullet_sim.world import World

BLACK = SceneDescription(ambient=(0.0, 0.0, 0.0, 1.0), background=(0.0, 0.0, 0.0, 1.0))
WHITE = replace(BLACK, background=(1.0, 1.0, 1.0, 1.0))
LAMP = Material(diffuse=(1.0, 1.0, 1.0, 1.0), lighting=False)
BARREL = (-0.3, 0.1, 0.002, -0.003, -0.02)
BENT = CameraDescription(horizontal_fov=1.4, width=320, height=240, distortion=BARREL)
FISHEYE = CameraDescription(horizontal_fov=3.0, width=240, height=240,
                            lens=Lens(env_texture_size=300))
RADIUS = {  # of a point at an angle, over the radius of the picture's edge
    (2.0, 2.0, "tan"): lambda a, edge: math.tan(a / 2) / math.tan(edge / 2),
    (1.0, 1.0, "id"): lambda a, edge: a / edge,
    (2.0, 2.0, "sin"): lambda a, edge: math.sin(a / 2) / math.sin(edge / 2),
    (1.0, 1.0, "sin"): lambda a, edge: math.sin(a) / math.sin(edge),
}


def camera(renderer, description, *visuals, scene=BLACK, kind="camera", **options):
    world = World(WorldDescription(scene=scene))
    sensor = SensorDescription("eye", kind, cameras=(description,))
    model = world.spawn(ModelDescription("robot", static=True, links=(
        LinkDescription("link", visuals=visuals),)))
    return Camera(world, model.link("link"), sensor, renderer, **options)


def lamp(place):
    """A small ball 5 m away in a direction of the camera's frame."""
    return Visual("lamp", Sphere(0.06), Pose(tuple(5 * np.array(place))), material=LAMP)


def spot(rgb):
    """Column and row of the middle of what is bright."""
    rows, columns = np.nonzero(rgb[..., 0] > 127)
    return np.array([columns.mean(), rows.mean()])


@pytest.mark.parametrize("noise, noisy", [(Noise("gaussian", 0.0, 0.1), True),
                                          (Noise("none", 0.0, 0.1), False),
                                          (Noise("gaussian", 0.2, 0.0), True)])
def test_only_gaussian_noise_is_seen(renderer, noise, noisy):
    small = CameraDescription(width=64, height=48)
    clean, seen = (camera(renderer, each).sample().rgb for each in (small, replace(
        small, noise=noise)))
    assert (clean != seen).any() == noisy


@pytest.mark.parametrize("across, down", [(0.0, 0.0), (0.5, 0.3), (-0.6, 0.2), (0.3, -0.45)])
def test_a_point_is_seen_where_browns_model_says(renderer, across, down):
    # conforms: sdf sensor/camera/distortion/k1, sdf sensor/camera/distortion/k2
    # conforms: sdf sensor/camera/distortion/k3, sdf sensor/camera/distortion/p1
    # conforms: sdf sensor/camera/distortion/p2
    eye = camera(renderer, BENT, lamp((1.0, -across, -down)), border_crop=False)
    focal = 320 / (2 * math.tan(0.7))
    place = np.array([[[across, down, 1.0]]])
    matrix = np.array([[focal, 0, 159.5], [0, focal, 119.5], [0, 0, 1]])
    expected = cv2.projectPoints(place, np.zeros(3), np.zeros(3), matrix, np.array(BARREL))[0]
    np.testing.assert_allclose(spot(eye.sample().rgb), expected.ravel(), atol=0.5)


def test_every_coefficient_counts_as_in_opencv():
    coefficients = np.array([-0.3, 0.1, 0.05, -0.04, -0.02])
    centre, focal = np.array([159.5, 119.5]), 200.0
    places = np.random.default_rng(1).uniform(-0.8, 0.8, (50, 3)) * (1, 1, 0) + (0, 0, 1)
    matrix = np.array([[focal, 0, centre[0]], [0, focal, centre[1]], [0, 0, 1]])
    expected = cv2.projectPoints(places, np.zeros(3), np.zeros(3), matrix, coefficients)[0][:, 0]
    bent = Distortion(replace(BENT, distortion=tuple(coefficients)), focal, crop=False)
    found = bent.seen_at(places[:, :2] * focal + centre)
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_opencv_makes_the_pinholes_picture_of_it_again(renderer):
    wall = Visual("wall", Plane((-1.0, 0.0, 0.0), (1.6, 1.0)), Pose((2.0, 0.0, 0.0)), LAMP)
    bent = camera(renderer, BENT, wall, border_crop=False).sample().rgb
    straight = camera(renderer, replace(BENT, distortion=(0.0,) * 5), wall).sample().rgb
    focal = 320 / (2 * math.tan(0.7))
    matrix = np.array([[focal, 0, 159.5], [0, focal, 119.5], [0, 0, 1]])
    again = cv2.undistort(bent, matrix, np.array(BARREL))
    assert (np.abs(again.astype(int) - straight) > 100).mean() < 0.005
    assert (np.abs(bent.astype(int) - straight) > 100).mean() > 0.01


def test_barrel_leaves_a_black_border_unless_it_is_cropped(renderer):
    whole = camera(renderer, BENT, scene=WHITE, border_crop=False).sample().rgb
    assert not whole[:4, :4].any() and (whole[120] == 255).all(axis=1).sum() < 320
    cropped = camera(renderer, replace(BENT, distortion=(-0.3, 0.0, 0.0, 0.0, 0.0)),
                     scene=WHITE).sample().rgb
    assert (cropped == 255).all()


def test_pincushion_is_never_cropped(renderer):
    cushion = replace(BENT, distortion=(0.2, 0.0, 0.0, 0.0, 0.0))
    pictures = [camera(renderer, cushion, lamp((1.0, 0.4, 0.1)), border_crop=crop).sample().rgb
                for crop in (True, False)]
    assert np.array_equal(*pictures)


def test_the_lens_may_sit_beside_the_middle(renderer):
    moved = replace(BENT, distortion=(-0.3, 0.0, 0.0, 0.0, 0.0), distortion_centre=(0.25, 0.5))
    focal = 320 / (2 * math.tan(0.7))
    across = (79.5 - 159.5) / focal  # what is seen at the lens's centre stays
    eye = camera(renderer, moved, lamp((1.0, -across, 0.0)), border_crop=False)
    np.testing.assert_allclose(spot(eye.sample().rgb), (79.5, 119.5), atol=0.5)


@pytest.mark.parametrize("kind", RADIUS)
@pytest.mark.parametrize("angle, turn", [(0.3, 0.2), (0.9, 2.0), (1.2, -1.0), (0.0, 0.0)])
def test_a_lens_shows_an_angle_at_its_radius(renderer, kind, angle, turn):
    # conforms: sdf sensor/camera/lens/type
    direction = (math.cos(angle), -math.sin(angle) * math.cos(turn),
                 -math.sin(angle) * math.sin(turn))
    c1, c2, function = kind
    lens = replace(FISHEYE.lens, c1=c1, c2=c2, function=function)
    eye = camera(renderer, replace(FISHEYE, lens=lens), lamp(direction), kind="wideanglecamera")
    radius = 120 * RADIUS[kind](angle, 1.5)
    expected = (119.5 + radius * math.cos(turn), 119.5 + radius * math.sin(turn))
    np.testing.assert_allclose(spot(eye.sample().rgb), expected, atol=0.7)


def test_an_own_function_without_scaling(renderer):
    """c1 f sin(theta / c2 + c3)"""
    lens = Lens(0.8, 1.2, 0.1, "sin", 1.5, scale_to_hfov=False, env_texture_size=300)
    place = lamp((math.cos(0.6), -math.sin(0.6), 0.0))
    eye = camera(renderer, replace(FISHEYE, lens=lens), place, kind="wideanglecamera")
    radius = 120 * 0.8 * 1.5 * math.sin(0.6 / 1.2 + 0.1)
    np.testing.assert_allclose(spot(eye.sample().rgb), (119.5 + radius, 119.5), atol=0.7)


def test_faces_meet_without_a_seam_and_what_is_beyond_the_cutoff_is_dim(renderer):
    # conforms: sdf sensor/camera/lens/cutoff_angle
    lens = Lens(1.0, 1.0, 0.0, "id", cutoff_angle=1.0, env_texture_size=64)
    whole = replace(FISHEYE, horizontal_fov=2 * math.pi, lens=lens)
    rgb = camera(renderer, whole, scene=WHITE, kind="wideanglecamera").sample().rgb
    rows, columns = np.indices(rgb.shape[:2]) - 119.5
    angle = np.hypot(rows, columns) / 120 * math.pi
    assert (rgb[angle < 0.99] == 255).all()
    assert (rgb[(angle > 1.01) & (angle < 3.1)] == 51).all()
    assert not rgb[angle > 3.2].any()


def test_a_small_cube_blurs(renderer):
    edge = Visual("wall", Plane((-1.0, 0.0, 0.0), (9.0, 9.0)), Pose((2.0, 4.5, 0.0)), LAMP)
    greys = [np.count_nonzero(np.isin(camera(
        renderer, replace(FISHEYE, lens=replace(FISHEYE.lens, env_texture_size=size)), edge,
        kind="wideanglecamera").sample().rgb, (0, 255), invert=True)) for size in (32, 512)]
    assert greys[0] > 3 * greys[1]


@pytest.mark.parametrize("changes, said", [
    ({"horizontal_fov": 7.0}, "<horizontal_fov> is 7.0, which is not between 0 and 2 pi"),
    ({"lens": Lens(1.0, 1.0, function="tan"), "horizontal_fov": 3.3}, "more than this <lens> can"),
    ({"lens": Lens(1.0, 1.0, -0.5, "tan"), "horizontal_fov": 1.0}, "more than this <lens> can"),
    ({"lens": Lens(env_texture_size=2)}, "<env_texture_size> is 2, which is not between 8 and"),
    ({"lens": Lens(c1=0.0)}, "<c1>, <c2> and <f> of a lens cannot be 0"),
])
def test_a_lens_that_cannot_be_is_said(renderer, changes, said):
    with pytest.raises(FormatError, match=f"sensor eye of robot::link: .*{said}"):
        camera(renderer, replace(FISHEYE, **changes), kind="wideanglecamera")
