"""`<velocity_decay>`: the part of its speed that a link loses in every step."""

import math

import pytest

from bullet_sim.description import Inertial, LinkDescription, ModelDescription, WorldDescription
from bullet_sim.pose import Pose, rotate
from bullet_sim.twist import Twist
from bullet_sim.world import World

UNLIKE = Inertial(2.0, inertia=(0.1, 0.0, 0.0, 0.2, 0.0, 0.25))  # about each axis


@pytest.fixture
def space():
    """`space(**decay)`: a body that lies aslant, without gravity."""
    world = World(WorldDescription(gravity=(0.0, 0.0, 0.0)))

    def spawn(**decay):
        link = LinkDescription("l", inertial=UNLIKE, **decay)
        return world, world.spawn(ModelDescription("m", links=(link,)),
                                  Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.3, -0.4, math.pi / 2)))
    yield spawn
    world.close()


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
def test_a_body_loses_its_part_about_each_of_its_axes(space, axis):
    world, model = space(angular_damping=0.01)
    spin = rotate(model.pose.orientation, axis)
    model.set_velocity(Twist((0.0, 0.0, 0.0), spin))
    world.step(100)
    assert model.twist.angular == pytest.approx([0.99 ** 100 * part for part in spin], abs=1e-3)


@pytest.mark.parametrize("decay", [1.0, 3.0])
def test_nobody_loses_more_than_it_has(space, decay):
    world, model = space(linear_damping=decay, angular_damping=decay)
    model.set_velocity(Twist((2.0, -1.0, 0.5), rotate(model.pose.orientation, (0.0, 0.0, 1.0))))
    world.step()
    assert model.twist.linear == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert model.twist.angular == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_what_is_slow_already_keeps_its_speed(space):
    """Below ODE's thresholds of 0.01 m/s and 0.01 rad/s."""
    world, model = space(linear_damping=0.1, angular_damping=0.1)
    slow = Twist((0.009, 0.0, 0.0), rotate(model.pose.orientation, (0.0, 0.009, 0.0)))
    model.set_velocity(slow)
    world.step(10)
    assert model.twist.linear == pytest.approx(slow.linear)
    assert model.twist.angular == pytest.approx(slow.angular, abs=1e-6)
    model.set_velocity(Twist((0.02, 0.0, 0.0), (0.0, 0.0, 0.0)))
    world.step(100)
    assert model.twist.linear[0] == pytest.approx(0.009, abs=1e-3)
