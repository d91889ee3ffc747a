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


@pytest.fixture(scope="module", params=["egl", "tiny"])
def renderer(request):
    opened = open_renderer(request.param)
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


@pytest.mark.parametrize("changes, said", [
    ({"width": 0}, "an image of 0x6 px"),
    ({"width": 100_000, "height": 100_000}, "an image of 100000x100000 px; .* draws at most "),
    ({"height": 100_000}, "an image of 8x100000 px; .* draws at most "),
    ({"horizontal_fov": 3.2}, "<horizontal_fov> is 3.2"),
    ({"near": 0.0}, "<clip> is from 0.0 to 10.0 m"),
    ({"near": 10.0}, "<clip> is from 10.0 to 10.0 m"),
    ({"far": float("inf")}, "<clip> is from 0.1 to inf m"),
    ({"near": float("nan")}, "<clip> is from nan to 10.0 m"),
])
def test_what_cannot_be_drawn_is_said(renderer, changes, said):
    with pytest.raises(FormatError, match=f"sensor eye of robot::link: {said}"):
        camera(renderer, **changes)
