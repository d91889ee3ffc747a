"""When nothing moves and when something is fast, with speeds that are given instead of an engine's.
"""

import math
from types import SimpleNamespace

import pytest

from bullet_sim.physics.auto_disable import AutoDisable

STEP = 0.001  # s; of 50 of them is a sample
STILL = 2e-4, 5e-3  # m/s and rad/s: what is slower counts as still
FAST = 0.05, 0.5


class Watched:
    """A body whose speed (m/s) and rate of turn (rad/s) are what the next sample finds.

    `motor`: whether it is to move; `held`: whether on wheels that its motors hold.
    """

    def __init__(self, motor: bool = False, held: bool = False):
        self.seen = (0.0, 0.0)
        self.rest = AutoDisable()
        self.rest.set_step(STEP)
        self.rest.bodies.append(SimpleNamespace(
            speeds=lambda: self.seen, wheels=SimpleNamespace(sample=lambda: held),
            joints=SimpleNamespace(wants_to_move=lambda: motor)))

    def samples(self, *seen: tuple[float, float]) -> bool:
        """Whether nothing needs to be solved after these."""
        for self.seen in seen:
            for _ in range(50):
                self.rest.step_needed()
        return self.rest.disabled


def test_ten_samples_in_a_row_without_motion_are_rest():
    watched = Watched()
    assert not watched.samples(*[(0.0, 0.0)] * 8)
    assert not watched.rest.nearly_disabled
    assert not watched.samples((0.0, 0.0))
    assert watched.rest.nearly_disabled
    assert watched.samples((0.0, 0.0))
    assert not watched.rest.nearly_disabled and not watched.rest.step_needed()
    assert watched.rest.steps == 500


@pytest.mark.parametrize("part, rests", [(0.99, True), (1.0, False)])
@pytest.mark.parametrize("turns", [False, True])
def test_what_counts_as_still(part, rests, turns):
    seen = (0.0, part * STILL[1]) if turns else (part * STILL[0], 0.0)
    assert Watched().samples(*[seen] * 20) == rests


def test_one_sample_with_motion_begins_the_row_anew():
    watched = Watched()
    watched.samples(*[(0.0, 0.0)] * 9, STILL)
    assert not watched.samples(*[(0.0, 0.0)] * 9)
    assert watched.samples((0.0, 0.0))


def test_a_motor_with_somewhere_to_go_is_no_rest():
    assert not Watched(motor=True).samples(*[(0.0, 0.0)] * 20)


@pytest.mark.parametrize("growth, rests", [(1.4, True), (1.6, False)])
@pytest.mark.parametrize("turns", [False, True])
def test_what_grows_by_half_begins_to_fall(growth, rests, turns):
    first = (0.0, 0.1 * STILL[1]) if turns else (0.1 * STILL[0], 0.0)
    last = tuple(growth * part for part in first)
    assert Watched().samples(*[first] * 9, last) == rests


@pytest.mark.parametrize("last, rests", [(0.9e-3, True), (1.1e-3, False)])
def test_what_is_a_thousandth_of_it_may_grow(last, rests):
    assert Watched().samples(*[(1e-9, 0.0)] * 9, (last * STILL[0], 0.0)) == rests


@pytest.mark.parametrize("seen, fast", [
    ((FAST[0], FAST[1]), False), ((1.01 * FAST[0], 0.0), True), ((0.0, 1.01 * FAST[1]), True)])
def test_what_counts_as_fast(seen, fast):
    watched = Watched()
    watched.samples(seen)
    assert watched.rest.is_fast == fast
    watched.samples((0.0, 0.0))
    assert not watched.rest.is_fast


def test_what_drives_on_held_wheels_is_not_fast():
    watched = Watched(held=True)
    assert not watched.samples(*[(10 * FAST[0], 10 * FAST[1])] * 20)
    assert not watched.rest.is_fast
    watched.rest.bodies += Watched().rest.bodies  # another one, that stands
    watched.samples((10 * FAST[0], 0.0))
    assert not watched.rest.is_fast


def test_a_speed_that_is_no_number_is_found_and_kept():
    watched = Watched()
    assert not watched.rest.found_nan
    watched.samples((math.nan, math.nan), (0.0, 0.0))
    assert watched.rest.found_nan


@pytest.mark.parametrize("step, steps", [(0.001, 50), (0.004, 12), (0.1, 1)])
def test_samples_are_a_twentieth_of_a_second_apart_or_a_step(step, steps):
    rest = AutoDisable()
    rest.set_step(step)
    assert rest.sample_steps == steps
