"""Planes in one place: one collides, and another takes over when it goes away."""

import pybullet
import pytest

from bullet_sim.description import (
    Box,
    Collision,
    Inertial,
    LinkDescription,
    ModelDescription,
    Plane,
    Surface,
)
from bullet_sim.pose import Pose

UP = (0.0, 0.0, 1.0)


def plane(name, normal=UP, laser_retro=0.0, **surface):
    shape = Collision("c", Plane(normal, (4.0, 4.0)), laser_retro=laser_retro,
                      surface=Surface(**({"mu": 100.0} | surface)))
    return ModelDescription(name, static=True, links=(LinkDescription("l", collisions=(shape,)),))


def box():
    inertia = (1e-3, 0.0, 0.0, 1e-3, 0.0, 1e-3)
    link = LinkDescription("l", inertial=Inertial(mass=0.6, inertia=inertia),
                           collisions=(Collision("c", Box((0.1, 0.1, 0.1))),))
    return ModelDescription("box", links=(link,))


def touched(world):
    """Numbers of the bodies that the box has contacts with, once for each contact."""
    return sorted(point[2] for point in world._client.read(
        pybullet.getContactPoints, world.model("box").bodies[0].number))


def number(world, name):
    return world.model(name).bodies[0].number


def settle(world):
    world.step(300)
    return world.model("box").pose.position[2]


@pytest.mark.parametrize("other", [
    {}, {"mu": 1.5}, {"normal": (0.0, -0.0, 1.0)}])  # more friction than 1 counts as 1
def test_of_two_planes_in_one_place_the_first_is_touched(world, other):
    world.spawn(plane("ground"))
    world.spawn(plane("course", **other))
    world.spawn(box(), Pose((0.3, 0.2, 0.05)))
    assert settle(world) == pytest.approx(0.05, abs=1e-4)
    assert touched(world) == [number(world, "ground")] * 4


@pytest.mark.parametrize("lower, count", [(1e-7, 4), (3e-6, 8)])
def test_places_are_told_apart_from_a_micrometre_on(world, lower, count):
    world.spawn(plane("ground"))
    world.spawn(plane("course"), Pose((0.0, 0.0, -lower)))
    world.spawn(box(), Pose((0.3, 0.2, 0.05)))
    settle(world)
    assert len(touched(world)) == count


def test_a_plane_that_comes_after_one_that_went_is_not_touched_either(world):
    """The engine gives it the number of the one that went."""
    for name in ("ground", "course"):
        world.spawn(plane(name))
    before = number(world, "course")
    world.delete("course")
    world.spawn(plane("other"))
    assert number(world, "other") == before
    world.spawn(box(), Pose((0.3, 0.2, 0.05)))
    settle(world)
    assert touched(world) == [number(world, "ground")] * 4


@pytest.mark.parametrize("leave", ["delete", "move"])
def test_when_the_first_goes_the_second_holds(world, leave):
    for name in ("ground", "course"):
        world.spawn(plane(name))
    world.spawn(box(), Pose((0.3, 0.2, 0.05)))
    settle(world)
    if leave == "delete":
        world.delete("ground")
    else:
        world.model("ground").set_pose(Pose((0.0, 0.0, -1.0)))
    assert settle(world) == pytest.approx(0.05, abs=1e-4)
    assert touched(world) == [number(world, "course")] * 4
    if leave == "move":
        world.model("ground").set_pose(Pose())
        settle(world)
        assert touched(world) == [number(world, "ground")] * 4


@pytest.mark.parametrize("other", [
    {"mu": 0.5}, {"normal": (0.0, 0.1, 0.995)}, {"restitution": 0.5}, {"laser_retro": 2.0},
])
def test_planes_that_differ_both_collide(world, other):
    world.spawn(plane("ground"))
    world.spawn(plane("course", **other))
    world.spawn(box(), Pose((0.0, 0.0, 0.05)))
    world.step(300)
    assert number(world, "course") in touched(world)


@pytest.mark.parametrize("first", [{"collides": False}, {"collide_bitmask": 1}])
def test_beside_a_plane_that_some_fall_through_another_collides(world, first):
    world.spawn(plane("first", **first))
    world.spawn(plane("ground"))
    world.spawn(box(), Pose((0.3, 0.2, 0.05)))
    assert settle(world) == pytest.approx(0.05, abs=1e-4)
    assert number(world, "ground") in touched(world)


def test_a_plane_moved_into_another_stops_colliding(world):
    world.spawn(plane("ground"))
    world.spawn(plane("course"), Pose((0.0, 0.0, -0.5)))
    world.model("course").set_pose(Pose((1.0, 2.0, 0.0)))
    world.spawn(box(), Pose((0.3, 0.2, 0.05)))
    settle(world)
    assert set(touched(world)) == {number(world, "ground")}
