"""Sensors against closed forms."""

import dataclasses
import math

import numpy as np
import pytest

from bullet_sim.description import (
    Box,
    Collision,
    ImuDescription,
    LinkDescription,
    ModelDescription,
    Noise,
    RayDescription,
    SensorDescription,
)
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.sensors.imu import ImuReading, ImuSensor, LinkMotion, LinkMotionReading
from bullet_sim.sensors.laser import Laser
from bullet_sim.sensors.odometry import GroundTruth
from bullet_sim.twist import Twist
from bullet_sim.world import World

ROOM = 4.0  # m, inner side of the square room
WALL = 0.1  # m, thickness


def room(retro: float = 0.0) -> ModelDescription:
    half = ROOM / 2 + WALL / 2
    places = {"east": (half, 0), "west": (-half, 0), "north": (0, half), "south": (0, -half)}
    links = tuple(
        LinkDescription(name, Pose((x, y, 0.5)), collisions=(Collision(
            name, Box((WALL, ROOM + 2 * WALL, 1.0) if x else (ROOM + 2 * WALL, WALL, 1.0)),
            laser_retro=retro if name == "east" else 0.0),))
        for name, (x, y) in places.items())
    return ModelDescription("room", static=True, links=links)


def carrier(ray: RayDescription, mount: Pose = IDENTITY) -> ModelDescription:
    sensor = SensorDescription("laser", "ray", pose=mount, ray=ray)
    housing = Collision("housing", Box((0.08, 0.08, 0.08)))
    return ModelDescription("robot", static=True, links=(
        LinkDescription("base_scan", collisions=(housing,), sensors=(sensor,)),))


def scan(ray: RayDescription, pose: Pose, mount: Pose = IDENTITY, retro: float = 0.0,
         with_room: bool = True):
    world = World(seed=7)
    if with_room:
        world.spawn(room(retro))
    model = world.spawn(carrier(ray, mount), pose)
    link = model.links["base_scan"]
    reading = Laser(world, link, link.description.sensors[0]).sample()
    world.close()
    return reading


def distance_to_room(x: float, y: float, angle: float) -> float:
    c, s = math.cos(angle), math.sin(angle)
    ways = [((ROOM / 2) * math.copysign(1, d) - p) / d
            for p, d in ((x, c), (y, s)) if abs(d) > 1e-9]
    return min(ways)


LDS = RayDescription(samples=360, min_angle=0.0, max_angle=6.28319, range_min=0.12, range_max=3.5)


@pytest.mark.parametrize("x, y, yaw", [(0, 0, 0), (0.7, -0.4, 0.3), (-1.1, 1.2, -2.0)])
def test_every_beam_meets_the_closed_form_within_2_mm(x, y, yaw):
    reading = scan(LDS, Pose.from_xyz_rpy((x, y, 0.5), (0, 0, yaw)))
    angles = yaw + np.linspace(LDS.min_angle, LDS.max_angle, 360)
    for measured, angle in zip(reading.ranges, angles, strict=True):
        expected = distance_to_room(x, y, angle)
        if expected < LDS.range_max - 0.002:
            assert measured == pytest.approx(expected, abs=0.002)
        elif expected > LDS.range_max + 0.002:
            assert math.isinf(measured)


def test_the_mount_turns_the_fan():
    ray = RayDescription(samples=1, min_angle=0.0, max_angle=0.0, range_min=0.1, range_max=10.0)
    mount = Pose.from_xyz_rpy((0.3, 0.0, 0.0), (0, 0, math.pi / 2))
    reading = scan(ray, Pose((0.5, 0.25, 0.5)), mount)
    assert reading.ranges[0] == pytest.approx(2.0 - 0.25, abs=0.002)


def test_nothing_hit_is_inf_and_nearer_than_the_minimum_is_minus_inf():
    open_field = scan(LDS, Pose((0, 0, 0.5)), with_room=False)
    assert np.all(np.isposinf(open_field.ranges))
    inside_wall = scan(RayDescription(samples=1, range_min=0.5, range_max=3.0),
                       Pose((1.52, 0.0, 0.5)))
    assert np.isneginf(inside_wall.ranges[0])


def test_intensity_is_the_laser_retro_of_what_was_hit():
    reading = scan(RayDescription(samples=2, min_angle=0.0, max_angle=math.pi, range_min=0.1,
                                  range_max=5.0), Pose((0, 0, 0.5)), retro=250.0)
    assert reading.intensities.tolist() == [250.0, 0.0]


def test_noise_has_its_deviation_and_repeats_with_the_seed():
    noisy = RayDescription(samples=2000, min_angle=-0.01, max_angle=0.01, range_min=0.1,
                           range_max=5.0, noise=Noise("gaussian", 0.0, 0.01))
    first, second = (scan(noisy, Pose((0, 0, 0.5))).ranges for _ in range(2))
    assert np.array_equal(first, second)
    assert np.std(first) == pytest.approx(0.01, rel=0.1)
    assert np.mean(first) == pytest.approx(2.0, abs=0.001)


def test_a_scan_may_have_more_beams_than_the_engine_takes_at_once():
    reading = scan(RayDescription(samples=20000, min_angle=-0.01, max_angle=0.01, range_min=0.1,
                                  range_max=5.0), Pose((0, 0, 0.5)))
    assert reading.ranges == pytest.approx(np.full(20000, 2.0), abs=0.002)


def test_motion_of_a_falling_and_of_a_turning_link():
    world = World()
    model = world.spawn(ModelDescription("thing", links=(LinkDescription("link"),)))
    model.set_twist(Twist((0, 0, 0), (0.0, 0.0, 2.0)))
    motion = LinkMotion(world, model.links["link"])
    assert motion.sample().world_acceleration == (0.0, 0.0, 0.0)
    for _ in range(100):
        world.step()
    reading = motion.sample()
    assert reading.world_acceleration == pytest.approx((0, 0, -9.8), abs=1e-3)
    assert reading.world_angular_velocity == pytest.approx((0, 0, 2.0), abs=1e-6)
    assert 2 * math.atan2(reading.orientation[2], reading.orientation[3]) == pytest.approx(
        0.2, abs=1e-3)
    world.close()


def test_an_imu_reads_in_its_own_axes_what_a_links_motion_has_in_the_worlds():
    world = World()
    lying = Pose.from_xyz_rpy((0.0, 0.0, 0.5), (math.pi / 2, 0.0, 0.0))  # its y is the world's z
    link = world.spawn(ModelDescription("thing", links=(LinkDescription("link"),), static=True),
                       lying).links["link"]
    sensor = SensorDescription("imu", "imu", imu=ImuDescription())
    felt, moved = ImuSensor(world, link, sensor).sample(), LinkMotion(world, link).sample()
    assert felt.linear_acceleration == pytest.approx((0.0, 9.8, 0.0), abs=1e-6)
    assert felt.orientation == pytest.approx(lying.orientation)
    assert moved.world_acceleration == (0.0, 0.0, 0.0)
    own, world_axes = ({field.name for field in dataclasses.fields(kind)}
                       for kind in (ImuReading, LinkMotionReading))
    assert own & world_axes == {"time", "orientation"}  # a mix-up is an AttributeError
    world.close()


def test_ground_truth_of_a_point_that_a_turning_link_carries():
    world = World()
    model = world.spawn(ModelDescription("thing", links=(LinkDescription("link"),)),
                        Pose.from_xyz_rpy((1.0, 2.0, 3.0), (0.0, 0.0, math.pi / 2)))
    model.set_twist(Twist((0.5, 0.0, 0.0), (0.0, 0.0, 2.0)))
    reading = GroundTruth(world, model.links["link"], Pose((0.1, 0.0, 0.0))).sample()
    assert reading.pose.position == pytest.approx((1.0, 2.1, 3.0), abs=1e-6)
    assert reading.twist.linear == pytest.approx((0.5 - 0.2, 0.0, 0.0), abs=1e-6)
    assert reading.twist.angular == pytest.approx((0.0, 0.0, 2.0), abs=1e-6)
    world.close()


def test_ground_truth_seen_from_another_link_is_in_its_axes():
    world = World()
    thing, other = (
        world.spawn(ModelDescription(name, links=(LinkDescription("link"),)),
                    Pose.from_xyz_rpy(position, (0.0, 0.0, math.pi / 2)))
        for name, position in (("thing", (0.0, 3.0, 0.0)), ("other", (0.0, 1.0, 0.0))))
    thing.set_twist(Twist((0.0, 1.0, 0.0)))
    other.set_twist(Twist((0.0, 0.25, 0.0), (0.0, 0.0, 1.0)))
    truth = GroundTruth(world, thing.links["link"], IDENTITY, other.links["link"])
    reading = truth.sample()
    assert reading.pose.position == pytest.approx((2.0, 0.0, 0.0), abs=1e-6)
    # The other's frame runs after it at 0.25 m/s and carries a point 2 m ahead to its left.
    assert reading.twist.linear == pytest.approx((0.75, -2.0, 0.0), abs=1e-6)
    assert reading.twist.angular == pytest.approx((0.0, 0.0, -1.0), abs=1e-6)
    world.close()
