"""The models and worlds that come with the simulator: made from their tables, of the size that
these say, and standing where they are put."""

import math
import subprocess
import sys

import numpy as np
import pytest
from prop_models import RESOURCES, bounds, load

from bullet_sim import props
from bullet_sim.description import (
    Box,
    Cylinder,
    Heightmap,
    Plane,
    Sphere,
)
from bullet_sim.errors import LONGEST_LINE, ResourceNotFound
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.pose import Pose
from bullet_sim.world import World

SPACING = 30.0  # m, between models that are tried in one world
LIMIT = 0.001  # m, and rad
TABLES = props.read_props()
PROPS = {name: table for name, table in TABLES.items() if "parts" in table}


def test_the_models_are_those_of_the_tables_after_each_change(tmp_path):
    tables, models = tmp_path / "props", tmp_path / "models"
    tables.mkdir()
    (tables / "lamp.sdf").write_text("<sdf/>")
    table = '[lamp]\nby_hand = "lamp.sdf"\n[cube]\nparts = [{box = [1, 1, 1], look = [0, 0, 1]}]\n'
    (tables / "all.toml").write_text(table)
    props.write_models(models, tables)
    assert (models / "lamp/model.sdf").read_text() == "<sdf/>"
    cube, config = models / "cube/model.sdf", models / "cube/model.config"
    assert "<size>1 1 1</size>" in cube.read_text() and "<name>cube</name>" in config.read_text()
    left_alone = config.stat().st_mtime_ns
    (tables / "all.toml").write_text(table[table.index("[cube]"):].replace("1, 1, 1", "2, 2, 2"))
    props.write_models(models, tables)
    assert "<size>2 2 2</size>" in cube.read_text()
    assert config.stat().st_mtime_ns == left_alone
    assert sorted(path.name for path in models.rglob("*")) == ["cube", "model.config", "model.sdf"]


def test_the_models_can_be_made_before_anything_is_installed():
    done = subprocess.run([sys.executable, "-I", "-S", props.__file__], capture_output=True,
                          text=True, check=False)
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


def test_they_are_small():
    assert sum(path.stat().st_size for path in DATA_FOLDER.rglob("*.*")) < 1_000_000


@pytest.mark.parametrize("name", PROPS)
def test_a_prop_measures_what_its_data_say(name):
    low, high = bounds(load(name))
    seen_only = not any(part.get("solid", True) for part in PROPS[name]["parts"])
    assert high - low == pytest.approx(PROPS[name]["size"], abs=0.003 if seen_only else 0.0006)


@pytest.fixture(scope="module")
def stood() -> dict[str, tuple[Pose, Pose]]:
    """Poses of all that can fall, put on the ground a second ago: then and now."""
    world = World(load_world(DATA_FOLDER / "worlds/empty.world", RESOURCES))
    placed = {}
    for number, name in enumerate(sorted(TABLES.keys() - {"sun", "ground_plane"})):
        model = load(name)
        if not model.static:
            column, row = divmod(number, 12)
            place = Pose((column * SPACING, row * SPACING, -bounds(model)[0][2]))
            placed[name] = world.spawn(model, place, name), place
    world.step(round(1.0 / world.timestep))
    return {name: (place, model.pose) for name, (model, place) in placed.items()}


FALLING = sorted([*(name for name, table in PROPS.items() if not table.get("static")),
                  "camera", "create", "depth_camera", "double_pendulum_with_base", "hinged_door",
                  "hokuyo", "kinect", "pioneer2at", "pioneer2dx", "simple_arm"])


@pytest.mark.parametrize("name", FALLING)
def test_what_can_fall_stands_for_a_second(stood, name):
    then, now = stood[name]
    moved = then.inverse() * now
    turned = 2 * math.acos(min(1.0, abs(moved.orientation[3])))
    assert np.abs(moved.position).max() < LIMIT and turned < 10 * LIMIT, moved


def test_all_that_can_fall_was_tried(stood):
    assert sorted(stood) == FALLING


@pytest.mark.parametrize(
    "name", sorted(path.name for path in (DATA_FOLDER / "worlds").glob("*.world")))
def test_a_world_loads_and_steps(name, caplog):
    world = World(load_world(DATA_FOLDER / "worlds" / name, RESOURCES))
    world.step(round(0.2 / world.timestep))
    assert not caplog.records
    for model in world.models.values():
        assert np.isfinite(model.pose.position).all() and model.pose.position[2] > -0.05, model.name
    plain = (Plane, Box, Cylinder, Sphere, Heightmap)
    assert all(isinstance(part.geometry, plain) for model in world.models.values()
               for link in model.description.links for part in link.visuals)


def test_a_world_that_is_not_there_is_answered_with_those_that_are():
    with pytest.raises(ResourceNotFound, match=(
            r"worlds/shape.world not found \(searched: .*\) \(did you mean shapes.world\?\); "
            r"there are: worlds/shapes.world, .*, …$")) as caught:
        RESOURCES.find_world("worlds/shape.world")
    assert len(str(caught.value)) < LONGEST_LINE  # else its middle would be left out


def saved(scale: str = "1 1 1", folder: str = "model://jersey_barrier") -> str:
    """A barrier as Gazebo's window saves it: no include, only the names of its meshes."""
    mesh = f"<mesh><uri>{folder}/meshes/jersey_barrier.dae</uri><scale>{scale}</scale></mesh>"
    return f"""<sdf version="1.6"><model name="barrier"><pose>1 2 0 0 0 0</pose><link name="link">
      <visual name="visual"><pose>0 0 1 0 0 1.5707963</pose><geometry>{mesh}</geometry>
        <transparency>0.25</transparency></visual>
      <collision name="collision"><pose>0 0 1 0 0 1.5707963</pose><geometry>{mesh}</geometry>
        <surface><friction><ode><mu>0.125</mu></ode></friction></surface></collision>
      </link></model></sdf>"""


@pytest.mark.parametrize("folder", [
    "model://jersey_barrier", "/opt/somewhere/.gazebo/models/jersey_barrier"])
def test_a_mesh_of_a_prop_that_is_not_here_is_the_props_own_shapes(caplog, folder):
    caplog.set_level("INFO", logger="bullet_sim")
    whole, link = load("jersey_barrier").links[0], load_model(saved(folder=folder),
                                                              RESOURCES).links[0]
    assert [part.geometry for part in link.visuals] == [part.geometry for part in whole.visuals]
    assert [part.material for part in link.visuals] == [part.material for part in whole.visuals]
    assert [part.geometry for part in link.collisions] == [
        part.geometry for part in whole.collisions]
    assert len({part.name for part in link.collisions}) == len(whole.collisions)
    placed = Pose.from_xyz_rpy((0, 0, 1), (0, 0, 1.5707963)) * whole.collisions[-1].pose
    assert link.collisions[-1].pose == placed == link.visuals[-1].pose
    assert {part.transparency for part in link.visuals} == {0.25}
    assert {part.surface.mu for part in link.collisions} == {0.125}
    assert [record.levelname for record in caplog.records] == ["INFO"]
    assert "the plain shapes of model://jersey_barrier are taken" in caplog.text


def test_other_missing_meshes_are_left_out(caplog):
    for text in (saved("2 0 2"), saved(folder="model://no_such"), saved(folder="model://..")):
        caplog.clear()
        link = load_model(text, RESOURCES).links[0]
        assert not link.visuals and not link.collisions
        assert "left out" in caplog.text
