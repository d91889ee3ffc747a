"""The benchmark's worlds: they can be read, and there is in them what is to be measured."""

from __future__ import annotations

import itertools
import os
import xml.etree.ElementTree as ElementTree

import pytest
import rospkg
from sim_bench.parts.worlds import TRIANGLES, WORLDS

from bullet_sim.description import Mesh
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.meshes.loading import load_mesh
from bullet_sim.world import World
from sim_bench import made_worlds


def read(made):
    """The description of a made world."""
    return load_world(made.file, Resources.from_environment(
        os.environ, find_package=rospkg.RosPack().get_path))


@pytest.mark.parametrize("name", WORLDS)
def test_a_world_is_read_without_a_warning(tmp_path, caplog, name):
    made = WORLDS[name](tmp_path)
    world = read(made)
    assert len(world.models) >= 2 and not caplog.records
    published = [element.text for element in ElementTree.parse(made.file).iter()
                 if element.tag in ("cameraName", "topicName")]
    assert all(any(f"/{name.strip('/')}" in f"/{topic.strip('/')}" for name in published)
               for topic in made.topics)


@pytest.mark.parametrize("name", [name for name in WORLDS if "playpen" not in name])
def test_every_picture_has_to_be_drawn(tmp_path, name):
    """One that shows the same as the last would not be."""
    world = World(read(WORLDS[name](tmp_path)))
    world.step(1500)  # until what falls has come to rest
    looks = []
    for _ in range(4):
        world.step(34)
        looks.append(world.update_scene().look())
    world.close()
    assert not any(before.equals(after) for before, after in itertools.pairwise(looks))


@pytest.mark.parametrize("triangles", TRIANGLES)
def test_signs_have_as_many_triangles_as_is_said(tmp_path, triangles):
    made_worlds.signs(tmp_path, triangles)
    (part,) = load_mesh(Mesh(str(tmp_path / "sign.stl")))
    assert made_worlds.SIGNS * len(part.faces) == pytest.approx(triangles, rel=0.1)


def test_the_same_world_has_the_same_bytes(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    for folder in (first, second):
        folder.mkdir()
        made_worlds.playpen(folder, 6)
        made_worlds.signs(folder, TRIANGLES[0])
    for name in ("floor.stl", "sign.stl", "sign_3.png", "signs.material"):
        assert (first / name).read_bytes() == (second / name).read_bytes()
