"""When a group that touches is disabled, with poses that are given instead of an engine's."""

from types import SimpleNamespace

from bullet_sim.physics.auto_disable import SAMPLE_PERIOD
from bullet_sim.physics.island_sleeping import IslandSleeping
from bullet_sim.physics.quiet import pybullet


def test_it_is_the_mean_over_the_last_second_that_counts():
    """0.15 m/s is too fast; below 0.1 m/s is the mean after a third of a second without motion."""
    place, asleep = 0.0, []

    def run(function, *args, activationState=None, **_):
        if function is pybullet.getBasePositionAndOrientation:
            return (place, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
        if activationState == pybullet.ACTIVATION_STATE_SLEEP:
            asleep.append(args[0])
        return [(0, 1, 2)] if function is pybullet.getContactPoints else None

    bodies = [SimpleNamespace(number=number, auto_disables=True,
                              tree=SimpleNamespace(fixed_base=False)) for number in (1, 2)]
    sleeping = IslandSleeping(run, bodies)
    for _ in range(60):
        place += 0.15 * SAMPLE_PERIOD
        sleeping.after_step(True)
    assert not asleep
    for _ in range(int(1 / 3 / SAMPLE_PERIOD)):
        sleeping.after_step(True)
    assert not asleep
    sleeping.after_step(True)
    assert sorted(asleep) == [1, 2]
