"""Two runs have one fingerprint if their states are the same to the bit, and only then."""

import math

import pytest
from rigs import body

from bullet_sim.fingerprint import description_hash, fingerprint
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.world import World

HEIGHT = 2.0  # m


def fallen(height: float = HEIGHT, steps: int = 50, name: str = "box"):
    world = World(seed=1)
    world.spawn(body("floor", size=(9, 9, 0.1), static=True))
    world.spawn(body(name, size=(0.2, 0.3, 0.4)), Pose((0.0, 0.0, height)))
    world.step(steps)
    found = fingerprint(world)
    world.close()
    return found


def test_one_run_has_one_fingerprint():
    assert fallen() == fallen()


@pytest.mark.parametrize("other", [
    {"height": math.nextafter(HEIGHT, 3)}, {"steps": 51}, {"name": "bot"}])
def test_every_bit_counts(other):
    assert fallen(**other) != fallen()


def test_the_way_there_counts_if_it_is_given():
    world = World()
    first = fingerprint(world)
    assert fingerprint(world, first) != first == fingerprint(world)
    world.close()


def world_text(plugin):
    return f"""<sdf version="1.6"><world name="w"><model name="m"><link name="l"/>
      <plugin name="p" filename="f.so">{plugin}</plugin></model></world></sdf>"""


def test_a_description_has_one_hash_and_another_one_another(tmp_path):
    path = tmp_path / "my.world"

    def read(text):
        path.write_text(text)
        return description_hash(load_world(path, Resources()))
    first = read(world_text("<rate>3</rate>"))
    assert read(world_text("<rate>3</rate>")) == first
    assert read(world_text("<rate>4</rate>")) != first
    assert read(world_text("<rate>3</rate>").replace('"l"', '"k"')) != first
