"""A world in other light: its file, and what a camera sees of it."""

import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import rospkg

from bullet_sim.description import (
    CameraDescription,
    LinkDescription,
    ModelDescription,
    SensorDescription,
)
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.sensors.camera import Camera
from bullet_sim.world import World
from trial_worlds.errors import WorldError
from trial_worlds.light import write_lit_world

PACKAGES = rospkg.RosPack()
PACKAGE = Path(PACKAGES.get_path("racecar_description"))
RACETRACK = PACKAGE / "worlds" / "racetrack.world"


def write_lit(folder: Path, factor: float) -> Path:
    return write_lit_world(RACETRACK, PACKAGE / "models", factor, folder)


def test_a_dimmer_world_differs_in_nothing_but_its_light(tmp_path):
    root = ElementTree.parse(write_lit(tmp_path, 0.5)).getroot().find("world")
    assert [element.text for element in root.findall("scene/ambient")] == ["0.2 0.2 0.2 1"]
    (sun,) = root.findall("light")
    assert sun.findtext("diffuse") == "0.4 0.4 0.4 1"
    uris = [element.text for element in root.findall("include/uri")]
    assert uris == ["model://ground_plane", "model://racetrack", "model://smartcar_plane"]
    before = ElementTree.parse(RACETRACK).getroot().find("world")
    assert len(root) == len(before)
    assert not (tmp_path / "models").exists()


@pytest.fixture(scope="module")
def renderer():
    opened = open_renderer()
    yield opened
    opened.close()


def seen(world_file: Path, renderer) -> np.ndarray:
    """The road, as a camera above the start line that looks down on it sees it (h, w, 3)."""
    models = [world_file.parent / "models", PACKAGE / "models"]
    resources = Resources.from_environment(
        extra_model_paths=models, extra_resource_paths=[PACKAGE], find_package=PACKAGES.get_path
    )
    pinhole = CameraDescription(width=64, height=48, horizontal_fov=1.0, near=0.1, far=10.0)
    eye = SensorDescription("eye", "camera", cameras=(pinhole,))
    body = ModelDescription("body", static=True, links=(LinkDescription("link"),))
    world = World(load_world(world_file, resources))
    try:
        above = Pose.from_xyz_rpy((1.0, 0.0, 1.0), (0.0, math.pi / 2, 0.0))
        model = world.spawn(body, above, "body")
        return Camera(world, model.link("link"), eye, renderer).sample().rgb.astype(float)
    finally:
        world.close()


@pytest.mark.parametrize("factor", [0.7, 1.0, 1.15, 1.3])
def test_the_camera_sees_the_light(tmp_path, renderer, factor):
    usual = seen(RACETRACK, renderer)
    found = seen(write_lit(tmp_path / "lit", factor), renderer)
    # Of what is not white. The usual light is 5 % above what a surface shows.
    dark = usual < 180
    assert dark.mean() > 0.5
    assert found[dark].mean() / usual[dark].mean() == pytest.approx(factor, abs=0.05)


def test_a_file_that_is_no_world_is_named(tmp_path):
    with pytest.raises(WorldError, match=r"none\.world: no world in which the light"):
        write_lit_world(tmp_path / "none.world", tmp_path, 1.0, tmp_path / "out")
