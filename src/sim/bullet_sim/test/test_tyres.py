"""Wheels touch the ground in their middle, and with their shoulders when they tilt."""

import itertools
import math
from types import SimpleNamespace

import pybullet
import pytest
import trimesh

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Heightmap,
    Inertial,
    JointDescription,
    LinkDescription,
    Mesh,
    ModelDescription,
    Plane,
    Surface,
)
from bullet_sim.physics.tyres import LEAST_CROWN, TREAD, crown
from bullet_sim.pose import Pose, rotate

RADIUS, WIDTH, TRACK = 0.05, 0.03, 0.3  # m
SOFT = 2e-4  # m, by which a loaded wheel sinks in, at most
# Part of the radius by which shoulders are smaller: 1.1 times 2 % of half the diagonal of the box.
CROWN = 1.1 * 0.02 * math.hypot(RADIUS, RADIUS, WIDTH / 2)
ROUNDED = 1e-3  # m, radius of the engine's edges
LIGHT = Inertial(0.2, inertia=(2e-4, 0, 0, 2e-4, 0, 2e-4))
HEAVY = Inertial(2.0, inertia=(0.02, 0, 0, 0.02, 0, 0.02))
AXLE = (0.0, 1.0, 0.0)
LAID = Pose.from_xyz_rpy((0, 0, 0), (math.pi / 2, 0, 0))
NOWHERE = Surface(collides=False)


@pytest.fixture
def shapes(tmp_path):
    """A wheel and a ground by the kind of their shape."""
    def export(name, shape):
        shape.export(tmp_path / f"{name}.stl")
        return Mesh(str(tmp_path / f"{name}.stl"))
    return {
        "cylinder": Cylinder(RADIUS, WIDTH),
        "mesh": export("wheel", trimesh.creation.cylinder(RADIUS, WIDTH, sections=48)),
        "on a plane": (Plane((0.0, 0.0, 1.0), (9.0, 9.0)), 0.0),
        "on a box": (Box((4.0, 4.0, 0.2)), -0.1),
        "on a mesh": (export("ground", trimesh.creation.box((4.0, 4.0, 0.2))), -0.1),
        "on a heightmap": (Heightmap(None, (4.0, 4.0, 1.0)), 0.0),
    }


def fixed(name: str, shape, pose: Pose = Pose()) -> ModelDescription:
    """A thing that does not move."""
    return ModelDescription(name, pose, static=True, links=(LinkDescription(
        "link", collisions=(Collision("c", shape, surface=Surface(mu=100.0, mu2=100.0)),)),))


def wheel(name: str, shape, pose: Pose) -> tuple[LinkDescription, JointDescription]:
    tyre = Collision("tyre", shape, LAID, Surface(mu=1.0, mu2=1.0))
    return (LinkDescription(name, pose, LIGHT, collisions=(tyre,)),
            JointDescription(name, "continuous", "base", name, axis=AXLE))


def car(shape) -> ModelDescription:
    """A cart on four wheels."""
    parts = [wheel(f"{x}{y}", shape, Pose((0.1 * x, TRACK / 2 * y, RADIUS)))
             for x, y in itertools.product((-1, 1), repeat=2)]
    base = LinkDescription("base", Pose((0, 0, RADIUS)), HEAVY)
    return ModelDescription("car", links=(base, *(link for link, _ in parts)),
                            joints=tuple(joint for _, joint in parts))


def on_a_rail(shape, tilt: float) -> ModelDescription:
    """A wheel, tilted by that angle (rad), that can only go up and down, and turn."""
    pose = Pose.from_xyz_rpy((0, 0, 0.1), (tilt, 0, 0))
    link, joint = wheel("wheel", shape, pose)
    rail = JointDescription("rail", "prismatic", "world", "base", axis=(0.0, 0.0, 1.0))
    return ModelDescription("rail", links=(LinkDescription("base", Pose((0, 0, 0.1)), HEAVY), link),
                            joints=(rail, joint))


def engine_contacts(world) -> list[tuple]:
    """All that the solver gets."""
    return world._client.read(pybullet.getContactPoints)


@pytest.mark.parametrize("tyre", ["cylinder", "mesh"])
@pytest.mark.parametrize("where", ["on a plane", "on a box", "on a mesh", "on a heightmap"])
def test_wheels_that_stand_upright_have_contacts_that_carry_something(
        world, shapes, tyre, where):
    shape, height = shapes[where]
    world.spawn(fixed("ground", shape, Pose((0.0, 0.0, height))))
    model = world.spawn(car(shapes[tyre]), Pose((0.02, 0.03, 0.0)))
    world.step(300)
    touching = engine_contacts(world)
    assert {row[3] for row in touching} == {0, 1, 2, 3}
    assert len(touching) == 4 or where == "on a heightmap"  # a tread may touch two triangles
    assert all(row[9] > 0.0 for row in touching)
    assert sum(row[9] for row in touching) == pytest.approx(9.8 * (2.0 + 4 * 0.2), rel=0.01)
    assert model.pose.position[2] == pytest.approx(0.0, abs=SOFT)


@pytest.mark.parametrize("tyre", ["cylinder", "mesh"])
@pytest.mark.parametrize("degrees", [-30, -10, 10, 30, 60])
def test_a_wheel_that_tilts_stands_on_its_shoulder(world, shapes, tyre, degrees):
    tilt = math.radians(degrees)
    world.spawn(fixed("ground", *shapes["on a plane"][:1]))
    model = world.spawn(on_a_rail(shapes[tyre], tilt))
    world.step(1500)
    part = 1.0 - CROWN / RADIUS if tyre == "mesh" else 1.0  # a mesh gets smaller as a whole
    expected = (RADIUS - CROWN) * math.cos(tilt) + part * WIDTH / 2 * abs(math.sin(tilt))
    expected -= ROUNDED * (math.cos(tilt) + abs(math.sin(tilt)) - 1.0)
    assert model.links["wheel"].pose.position[2] == pytest.approx(expected, abs=SOFT)
    ideal = RADIUS * math.cos(tilt) + WIDTH / 2 * abs(math.sin(tilt))
    assert 0.0 < ideal - expected < 0.04 * RADIUS  # what shoulders lack


def test_a_wheel_that_hardly_tilts_stands_on_its_tread(world, shapes):
    tilt = math.radians(3)
    world.spawn(fixed("ground", *shapes["on a plane"][:1]))
    model = world.spawn(on_a_rail(shapes["cylinder"], tilt))
    world.step(1500)
    expected = RADIUS * math.cos(tilt) + TREAD / 2 * math.sin(tilt)
    assert model.links["wheel"].pose.position[2] == pytest.approx(expected, abs=SOFT)


@pytest.mark.parametrize("tyre", ["cylinder", "mesh"])
def test_wheels_with_one_side_on_a_kerb_stand_on_it(world, shapes, tyre):
    kerb = 0.02  # m high, under the outer 5 mm of the left wheels
    world.spawn(fixed("ground", *shapes["on a plane"][:1]))
    inner = TRACK / 2 + WIDTH / 2 - 0.005
    world.spawn(fixed("kerb", Box((1.0, 0.2, kerb)), Pose((0.0, inner + 0.1, kerb / 2))))
    model = world.spawn(car(shapes[tyre]), Pose((0.0, 0.0, kerb)))
    world.step(1500)
    # It turns about its right treads, until the left shoulders lie on the kerb's edge.
    reach = inner + TRACK / 2 + TREAD / 2
    roll = (kerb - CROWN) / reach
    assert model.pose.rpy()[0] == pytest.approx(roll, abs=1e-3)
    left = (TRACK + TREAD / 2) * math.sin(roll) + RADIUS * math.cos(roll)
    assert model.links["11"].pose.position[2] == pytest.approx(left, abs=3e-4)


def test_a_car_on_its_side_lies_on_the_faces_of_its_wheels(world, shapes):
    world.spawn(fixed("ground", *shapes["on a plane"][:1]))
    start = Pose.from_xyz_rpy((0, 0, TRACK / 2 + WIDTH / 2 + 0.005), (math.pi / 2, 0, 0))
    model = world.spawn(car(shapes["cylinder"]), start * Pose((0, 0, -RADIUS)))
    world.step(2000)
    height = model.links["base"].pose.position[2]
    assert height == pytest.approx(TRACK / 2 + WIDTH / 2, abs=SOFT)
    assert rotate(model.pose.orientation, AXLE)[2] == pytest.approx(1.0, abs=1e-3)


def test_a_car_across_a_slope_leans_as_the_slope_does(world, shapes):
    tilt = 0.25  # rad; wheels are in line with the slope: it stands on its treads
    world.spawn(fixed("ground", shapes["on a plane"][0],
                      Pose.from_xyz_rpy((0, 0, 0), (tilt, 0, 0))))
    start = Pose.from_xyz_rpy((0, 0, 0), (tilt, 0, 0)) * Pose((0, 0, 0.001))
    model = world.spawn(car(shapes["cylinder"]), start)
    for joint in model.joints.values():
        joint.drive_velocity(0.0, 10.0)
    world.step(1000)
    assert model.pose.rpy()[0] == pytest.approx(tilt, abs=1e-3)
    assert len(engine_contacts(world)) == 4


def test_shoulders_that_a_robot_may_stand_upright_by_are_hardly_smaller(world, shapes):
    """A roller is as wide as it is high: nothing else holds it level."""
    roller = Cylinder(RADIUS, 2 * RADIUS)
    world.spawn(fixed("ground", *shapes["on a plane"][:1]))
    model = world.spawn(on_a_rail(roller, math.radians(10)))
    world.step(1500)
    cos, sin = math.cos(math.radians(10)), math.sin(math.radians(10))
    expected = (RADIUS - LEAST_CROWN) * cos + RADIUS * sin - ROUNDED * (cos + sin - 1.0)
    assert model.links["wheel"].pose.position[2] == pytest.approx(expected, abs=SOFT)


@pytest.mark.parametrize("boom", [0.5, 3.0])
def test_what_else_is_on_a_wheels_link_does_not_eat_its_shoulders(boom):
    """A turntable or hub with a boom: its box is much larger than the wheel."""
    parts = (Collision("tyre", Cylinder(0.1, 0.05), LAID),
             Collision("boom", Box((boom, 0.02, 0.02)), Pose((boom / 2, 0.0, 0.0))))
    link = SimpleNamespace(collisions=parts)
    tyre = SimpleNamespace(radius=0.1, width=0.05)
    assert crown(link, tyre) == LEAST_CROWN
