"""What is put into the ground comes out of it slowly and upright."""

import itertools

import pytest

from bullet_sim.description import (
    Box,
    Collision,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    Plane,
    Surface,
    WorldDescription,
)
from bullet_sim.physics import correcting_velocity
from bullet_sim.physics.correcting_velocity import FASTEST
from bullet_sim.pose import Pose
from bullet_sim.world import World

HALF = 0.1  # m, of the cube's height
HARD, SOFT = Surface(), Surface(kp=1e5, kd=1.0)
SPRINGY = Surface(restitution=0.9)


def floor(surface: Surface = HARD) -> ModelDescription:
    """Level ground."""
    plane = Collision("plane", Plane((0.0, 0.0, 1.0), (10.0, 10.0)), surface=surface)
    return ModelDescription("floor", static=True, links=(
        LinkDescription("link", collisions=(plane,)),))


def cube(mass: float, surface: Surface = HARD) -> ModelDescription:
    """A cube of that mass, kg."""
    moment = 0.01 * mass
    return ModelDescription("cube", links=(LinkDescription(
        "link", inertial=Inertial(mass, inertia=(moment, 0, 0, moment, 0, moment)),
        collisions=(Collision("c", Box((2 * HALF,) * 3), surface=surface),)),))


CUBE = cube(1.0)


@pytest.fixture
def world():
    made = World(WorldDescription(models=(floor(),)))
    yield made
    made.close()


def heights(world, model, seconds):
    found = []
    for _ in range(round(seconds / 0.01)):
        world.step(10)
        found.append(model.pose.position[2])
    return found


@pytest.mark.parametrize("depth", [0.02, 0.06, 0.15])
def test_a_spawned_body_rises_to_the_floor_and_no_higher(world, depth):
    rising = heights(world, world.spawn(CUBE, Pose((0, 0, HALF - depth))), 2.0)
    assert max(rising) < HALF + 0.005
    assert rising[-1] == pytest.approx(HALF, abs=0.001)
    fastest = max(b - a for a, b in itertools.pairwise(rising)) / 0.01
    assert 0.5 * FASTEST < fastest < 1.1 * FASTEST


@pytest.mark.parametrize("mass", [0.01, 0.1, 100.0])
def test_light_things_leave_no_faster(world, mass):
    rising = heights(world, world.spawn(cube(mass), Pose((0, 0, HALF - 0.06))), 2.0)
    assert max(rising) < HALF + 0.002
    assert max(b - a for a, b in itertools.pairwise(rising)) / 0.01 < 1.1 * FASTEST


@pytest.mark.parametrize("ground, thing", [
    (HARD, SOFT), (SOFT, HARD), (SOFT, SOFT), (HARD, SPRINGY), (SPRINGY, SPRINGY)])
def test_whatever_the_surfaces_are_like(ground, thing):
    world = World(WorldDescription(models=(floor(ground),)))
    rising = heights(world, world.spawn(cube(1.0, thing), Pose((0, 0, HALF - 0.06))), 3.0)
    assert max(rising) < HALF + 0.005
    assert rising[-1] == pytest.approx(HALF, abs=0.001)
    assert max(b - a for a, b in itertools.pairwise(rising)) / 0.01 < 1.1 * FASTEST
    world.close()


def test_a_moved_body_does_so_too(world):
    cube = world.spawn(CUBE, Pose((0, 0, HALF)))
    world.step(1000)
    cube.set_pose(Pose((0, 0, 0.03)))
    assert max(heights(world, cube, 2.0)) < HALF + 0.005
    assert abs(cube.pose.rpy()[0]) < 0.01


def test_beside_what_is_held_deep_a_body_leaves_as_slowly(world):
    """The part that all correct stays the same then."""
    arm = LinkDescription("arm", collisions=CUBE.links[0].collisions)
    world.spawn(ModelDescription("robot", links=(LinkDescription("base"), arm), joints=(
        JointDescription("base", "fixed", "world", "base"),
        JointDescription("arm", "fixed", "base", "arm"))), Pose((1.0, 0.0, 0.0)))
    world.step(100)
    rising = heights(world, world.spawn(CUBE, Pose((0, 0, HALF - 0.06))), 2.0)
    assert max(b - a for a, b in itertools.pairwise(rising)) / 0.01 < 1.1 * FASTEST


def test_what_is_deep_for_good_is_left_to_the_engine_in_the_end(world, monkeypatch):
    monkeypatch.setattr(correcting_velocity, "LONGEST", 0.1)
    cube = world.spawn(CUBE, Pose((0, 0, 0.02)))
    assert max(heights(world, cube, 1.0)) > HALF + 0.1
