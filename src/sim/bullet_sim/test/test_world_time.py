"""Simulated time when the length of a step changes, and which lengths are possible."""

import math
from itertools import pairwise

import pytest

from bullet_sim.description import PhysicsDescription, WorldDescription
from bullet_sim.errors import SimulationError
from bullet_sim.world import World


@pytest.fixture
def world():
    made = World(initial_time=5.0)
    yield made
    made.close()


@pytest.mark.parametrize("steps", [1, 2, 3, 5, 44, 99])
@pytest.mark.parametrize("new_step", [0.0005, 0.002, 0.003, 0.1])
def test_another_step_length_never_sets_time_back_and_skips_less_than_a_step(
        world, steps, new_step):
    world.step(steps)
    before = world.time
    world.configure_physics(max_step_size=new_step)
    assert -1e-9 < world.time - before < new_step


def test_time_goes_on_in_steps_of_the_new_length(world):
    times = [world.time]
    for step in (0.001, 0.002, 0.004):
        world.configure_physics(max_step_size=step)
        world.step(2)
        times.append(world.time)
    assert times == pytest.approx([5.0, 5.002, 5.006, 5.016])  # 5.006 is not whole steps of 4 ms
    assert all(now > before for before, now in pairwise(times))


def test_no_step_is_no_time(world):
    world.step(0)
    assert world.time == 5.0


def test_a_reset_leads_back_to_the_same_time_whatever_the_step(world):
    world.step(100)
    world.configure_physics(max_step_size=0.002)
    world.step(100)
    world.reset_simulation()
    assert world.time == 5.0


OUTSIDE = {
    "max_step_size": (0.0, -0.001, 0.99e-5, 0.101, math.nan, math.inf),
    "real_time_update_rate": (-1.0, 1e6 + 0.5, math.nan, math.inf),
    "iterations": (-1, 10_001, 2 ** 40),
    "residual": (0.0, -1e-7, 0.0101, math.nan, math.inf),
}


@pytest.mark.parametrize("name, value", [
    ("max_step_size", 1e-5), ("max_step_size", 0.1), ("real_time_update_rate", 0.0),
    ("real_time_update_rate", 1e6), ("iterations", 0), ("iterations", 10_000),
    ("residual", 1e-12), ("residual", 0.01)])
def test_the_bounds_themselves_are_possible(world, name, value):
    world.configure_physics(**{name: value})
    assert getattr(world.description.physics, name) == value


@pytest.mark.parametrize("name, value", [(n, v) for n, values in OUTSIDE.items() for v in values])
def test_what_is_not_possible_is_an_error_that_says_so_and_changes_nothing(
        world, name, value, caplog):
    world.step(10)
    before = world.description, world.tick
    with pytest.raises(SimulationError, match="not possible"):
        world.configure_physics(**{"gravity": (0.0, 0.0, -1.0), name: value})
    assert (world.description, world.tick) == before
    made = World(WorldDescription(physics=PhysicsDescription(**{name: value})))
    assert made.description.physics == PhysicsDescription()
    assert "not possible" in caplog.text and "is used instead" in caplog.text
