"""When a group that touches is disabled, with poses that are given instead of an engine's."""

import math
from types import SimpleNamespace

import pytest

from bullet_sim.physics.auto_disable import SAMPLE_PERIOD
from bullet_sim.physics.engine import pybullet
from bullet_sim.physics.island_sleeping import IslandSleeping


class Pair:
    """Bodies that touch, always at the same place (m) along x and turned (rad) about z."""

    def __init__(self, bodies: int = 2):
        self._contacts = [(0, number, number + 1) for number in range(1, bodies)]
        self.place = self.turn = 0.0
        self.asleep: list[int] = []
        self.pushes: list[tuple] = []
        self._sleeping = IslandSleeping(self._run, [
            SimpleNamespace(number=number + 1, auto_disables=True,
                            tree=SimpleNamespace(fixed_base=False)) for number in range(bodies)])

    def _run(self, function, *args, activationState=None, **_):
        if function is pybullet.getBasePositionAndOrientation:
            half = self.turn / 2
            return (self.place, 0.0, 0.0), (0.0, 0.0, math.sin(half), math.cos(half))
        if function is pybullet.resetBaseVelocity:
            self.pushes.append(args)
        if activationState == pybullet.ACTIVATION_STATE_SLEEP:
            self.asleep.append(args[0])
        return self._contacts if function is pybullet.getContactPoints else None

    def change(self, function, *args) -> None:
        """As a client does: what sleeps is enabled first."""
        self._sleeping.changed(function, args)
        self._run(function, *args)

    def look(self, times: int, speed: float = 0.0, rate: float = 0.0) -> None:
        """So often, after they have moved at m/s and rad/s for a sample's time each."""
        for _ in range(times):
            self.place += speed * SAMPLE_PERIOD
            self.turn += rate * SAMPLE_PERIOD
            self._sleeping.after_step(True)


@pytest.mark.parametrize("fast", [{"speed": 0.15}, {"rate": 0.15}])
def test_it_is_the_mean_over_the_last_second_that_counts(fast):
    """0.15 m/s or rad/s is too fast; the mean is below 0.1 after a third of a second of rest."""
    pair = Pair()
    pair.look(60, **fast)
    assert not pair.asleep
    pair.look(int(1 / 3 / SAMPLE_PERIOD))
    assert not pair.asleep
    pair.look(1)
    assert sorted(pair.asleep) == [1, 2]


def test_what_stands_still_from_the_first_look_is_disabled_a_second_later():
    pair = Pair()
    pair.look(1)
    pair.look(round(1.0 / SAMPLE_PERIOD) - 1)
    assert not pair.asleep
    pair.look(1)
    assert sorted(pair.asleep) == [1, 2]


def test_a_push_of_what_wakes_counts_after_another_is_removed_and_goes_with_its_own_body():
    """The engine's next step leaves out what wakes: a push is given again after it."""
    pair = Pair()
    pair.look(round(1.0 / SAMPLE_PERIOD) + 1)
    for number in (1, 2):
        pair.change(pybullet.resetBaseVelocity, number, (0.5, 0.0, 0.0))
    pair.change(pybullet.removeBody, 1)
    pair.pushes.clear()
    pair.look(1)
    assert pair.pushes == [(2, (0.5, 0.0, 0.0))]


@pytest.mark.parametrize("bodies, samples", [(63, 20), (64, 5)])
def test_many_bodies_are_disabled_after_a_quarter_of_a_second(bodies, samples):
    pair = Pair(bodies)
    pair.look(10, speed=0.5)
    pair.look(samples - 1)
    assert not pair.asleep
    pair.look(1)
    assert len(pair.asleep) == bodies


def test_many_bodies_that_go_on_moving_are_not_disabled():
    pair = Pair(64)
    pair.look(60, speed=0.15)
    assert not pair.asleep
