"""Cameras that nobody can draw are an error that says why, before anything is drawn."""

from dataclasses import replace

import pytest

from bullet_sim.description import (
    CameraDescription,
    LinkDescription,
    ModelDescription,
    SensorDescription,
)
from bullet_sim.errors import FormatError
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.sensors.camera import Camera
from bullet_sim.world import World

GOOD = CameraDescription(width=8, height=6, near=0.1, far=10.0)


@pytest.fixture(scope="module")
def renderer():
    opened = open_renderer()
    yield opened
    opened.close()


def camera(renderer, **changes):
    world = World()
    model = world.spawn(ModelDescription("robot", static=True, links=(LinkDescription("link"),)))
    sensor = SensorDescription("eye", "camera", cameras=(replace(GOOD, **changes),))
    return Camera(world, model.link("link"), sensor, renderer)


def test_what_is_in_order_is_drawn(renderer):
    assert camera(renderer).sample().rgb.shape == (6, 8, 3)
    assert camera(renderer, width=renderer.largest_px).sample().rgb.shape[1] == renderer.largest_px


@pytest.mark.parametrize("width, height, used", [
    (100_000, 100_000, (4096, 4096)), (10_000, 200, (8192, 163)), (16, 100_000, (1, 8192))])
def test_a_picture_that_is_too_large_is_drawn_smaller(renderer, caplog, width, height, used):
    eye = camera(renderer, width=width, height=height)
    assert (eye.description.width, eye.description.height) == used
    assert (eye.view().width, eye.view().height) == used
    assert (f"sensor eye of robot::link: an image of {width}x{height} px is not drawn, at most "
            f"8192 per side and 4096x4096 in all; {used[0]}x{used[1]} is used") in caplog.text


def test_memory_of_pictures_is_given_back():
    drawing = open_renderer()
    eye = camera(drawing)
    first = eye.sample().rgb
    assert drawing._targets
    drawing.trim()
    assert not drawing._targets
    assert (eye.sample().rgb == first).all()  # it goes on
    drawing.close()


@pytest.mark.parametrize("changes, said", [
    ({"width": 0}, "an image of 0x6 px"),
    ({"horizontal_fov": 3.2}, "<horizontal_fov> is 3.2"),
    ({"near": 0.0}, "<clip> is from 0.0 to 10.0 m"),
    ({"near": 10.0}, "<clip> is from 10.0 to 10.0 m"),
    ({"far": float("inf")}, "<clip> is from 0.1 to inf m"),
    ({"near": float("nan")}, "<clip> is from nan to 10.0 m"),
])
def test_what_cannot_be_drawn_is_said(renderer, changes, said):
    with pytest.raises(FormatError, match=f"sensor eye of robot::link: {said}"):
        camera(renderer, **changes)
