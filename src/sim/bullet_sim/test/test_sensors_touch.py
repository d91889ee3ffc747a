"""What a body feels: contacts, net force, joints, and the nearest thing along rays."""

import logging
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from rigs import body, hinge, part, rig, slider

from bullet_sim.description import (
    Box,
    Collision,
    ModelDescription,
    RayDescription,
    SensorDescription,
    WorldDescription,
)
from bullet_sim.errors import FormatError
from bullet_sim.pose import Pose
from bullet_sim.sensors.contact import ContactSensor, NetForce
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim.sensors.laser import MOST_RAYS, RayFan, fewer_rays
from bullet_sim.twist import Twist
from bullet_sim.world import World

G = 9.8  # m/s^2
FLOOR = body("floor", (2.0, 2.0, 0.2), static=True)


@pytest.fixture
def world():
    made = World(WorldDescription(gravity=(0.0, 0.0, -G)))
    yield made
    made.close()


def sensor(*collisions: str) -> SensorDescription:
    names = "".join(f"<collision>{name}</collision>" for name in collisions)
    return SensorDescription("touch", "contact", element=ElementTree.fromstring(
        f"<sensor><contact>{names}</contact></sensor>"))


@pytest.fixture
def standing(world):
    """A cube of 1 kg that stands on the floor, its centre of mass 2 cm off its middle."""
    world.spawn(FLOOR, Pose((0.0, 0.0, -0.1)))
    cube = world.spawn(body("cube", (0.1, 0.1, 0.1), com=(0.02, 0.0, 0.0)), Pose((0.0, 0.0, 0.05)))
    world.step(300)
    return world, cube


def felt(world: World, link, description: SensorDescription, samples: int = 50):
    """The mean force (N) and torque (N m) of a contact sensor, and its last pairs."""
    made, sums = ContactSensor(world, link, description), np.zeros((2, 3))
    for _ in range(samples):
        world.step()
        pairs = made.sample()
        for pair in pairs:
            sums += np.sum(pair.forces, axis=0), np.sum(pair.torques, axis=0)
    return *(sums / samples), pairs


def test_what_stands_feels_its_weight_and_no_torque(standing):
    world, cube = standing
    force, torque, pairs = felt(world, cube.links["l"], sensor())
    assert force == pytest.approx((0.0, 0.0, G), abs=0.1)
    assert torque == pytest.approx((0.0, 0.0, 0.0), abs=0.01)  # about the centre of mass
    (pair,) = pairs
    assert (pair.own, pair.other) == ("cube::l::c", "floor::l::c")
    assert len(pair.positions) == len(pair.depths) == len(pair.normals) == len(pair.forces)
    assert all(normal == pytest.approx((0.0, 0.0, 1.0), abs=1e-3) for normal in pair.normals)
    assert all(0.0 <= depth < 0.002 for depth in pair.depths)


@pytest.mark.parametrize("description", [
    sensor("c"), sensor("__default__"), sensor("floor::l::c"),
    SensorDescription("touch", "contact")])
def test_the_floor_feels_the_weight_from_above(standing, description):
    world, _ = standing
    force, _, ((pair),) = felt(world, world.link("floor::l"), description)
    assert force == pytest.approx((0.0, 0.0, -G), abs=0.1)
    assert (pair.own, pair.other) == ("floor::l::c", "cube::l::c")


def test_a_sensor_may_name_a_collision_of_another_link(standing):
    world, _ = standing
    force, _, _ = felt(world, world.link("floor::l"), sensor("cube::l::c"))
    assert force == pytest.approx((0.0, 0.0, G), abs=0.1)


def test_a_collision_that_is_not_there_is_said(standing, caplog):
    world, cube = standing
    with caplog.at_level(logging.ERROR):
        made = ContactSensor(world, cube.links["l"], sensor("bumper"))
    assert "feels nothing at collision 'bumper', which is not there; there are: c" in caplog.text
    assert made.sample() == []


# --- net force

def test_what_falls_is_pulled_by_its_weight(world):
    link = world.spawn(body("a")).links["l"]
    world.step(100)
    force = NetForce(world, link)
    assert not force.sample().any()  # at first
    world.step(10)
    assert force.sample() == pytest.approx([0.0, 0.0, -G, 0.0, 0.0, 0.0], abs=1e-3)
    assert not force.sample().any()  # no time has passed
    force.restart()
    world.step()
    assert not force.sample().any()


def test_net_force_and_torque_are_those_at_the_centre_of_mass(world):
    world.configure_physics(gravity=(0.0, 0.0, 0.0))
    model = world.spawn(body("a", com=(0.2, 0.0, 0.0)))
    model.set_velocity(Twist((1.0, 0.0, 0.0)))
    force = NetForce(world, model.links["l"])
    force.sample()
    model.links["l"].apply_force((3.0, 0.0, 1.0), (0.0, 0.0, 0.02))
    world.step()
    assert force.sample() == pytest.approx([3.0, 0.0, 1.0, 0.0, 0.0, 0.02], abs=1e-3)


def test_what_stands_has_no_net_force(standing):
    world, cube = standing
    force = NetForce(world, cube.links["l"])
    force.sample()
    world.step(50)
    assert force.sample() == pytest.approx(np.zeros(6), abs=0.02)


# --- joint states

def test_joints_are_read_in_the_order_of_the_request(world):
    world.configure_physics(gravity=(0.0, 0.0, 0.0))
    joints = world.spawn(rig(hinge("a"), slider("b", (1, 0, 0)))).joints
    joints["a"].reset(0.5, 2.0)
    joints["b"].reset(-0.25, -1.0)
    world.tick = 40
    reading = sample_joints(world, [joints["b"], joints["a"]])
    assert reading.names == ("b", "a")
    assert reading.time == pytest.approx(0.04)
    assert reading.positions == pytest.approx((-0.25, 0.5))
    assert reading.velocities == pytest.approx((-1.0, 2.0))


# --- rays

def fan(world: World, ray: RayDescription | None) -> RayFan:
    model = world.spawn(ModelDescription("eye", static=True, links=(part("l"),)))
    return RayFan(world, model.links["l"], SensorDescription("sonar", "ray", ray=ray))


CONE = RayDescription(samples=11, min_angle=-0.5, max_angle=0.5, range_min=0.1, range_max=5.0)


@pytest.mark.parametrize("distance, nearest", [(2.0, 1.95), (9.0, 5.0)])
def test_the_nearest_thing_is_measured_or_the_range(world, distance, nearest):
    wall = replace(FLOOR.links[0], collisions=(Collision("c", Box((0.1, 9.0, 9.0))),))
    world.spawn(ModelDescription("wall", static=True, links=(wall,)), Pose((distance, 0.0, 0.0)))
    assert fan(world, CONE).nearest() == pytest.approx(nearest, abs=1e-3)


def test_a_sensor_without_ray_is_said(world):
    with pytest.raises(FormatError, match="sensor sonar of eye::l has no <ray>"):
        fan(world, None)


def test_too_many_rays_are_thinned_over_the_same_angles(world, caplog):
    made = fan(world, replace(CONE, samples=1000, vertical_samples=1000,
                              vertical_min_angle=-0.2, vertical_max_angle=0.2))
    assert made.shape == (316, 316)
    assert (made.azimuths[0], made.azimuths[-1]) == (-0.5, 0.5)
    assert (made.elevations[0], made.elevations[-1]) == (-0.2, 0.2)
    assert "has 1000 x 1000 rays, but at most 100000 are cast: 316 x 316" in caplog.text


@pytest.mark.parametrize("asked, cast", [
    ((10**6, 4), (25_000, 4)), ((4, 10**6), (4, 25_000)), ((10**6, 1), (MOST_RAYS, 1))])
def test_the_longer_side_is_thinned_first(asked, cast):
    assert fewer_rays(*asked) == cast
