"""How hard contacts are where the surface does not say so."""

import math

import pytest

from bullet_sim.description import Surface
from bullet_sim.physics.contact_parameters import hardness

GRAVITY = 9.81  # m/s^2


@pytest.mark.parametrize("mass", [30.0, 1000.0])
def test_three_contacts_carry_a_body_a_twentieth_of_a_millimetre_deep_without_a_swing(mass):
    values = hardness(Surface(), False, mass)
    share = mass / 3.0
    assert share * GRAVITY / values["contactStiffness"] == pytest.approx(5e-5)
    # The damping ratio of a mass on a spring: from 1 on it comes back without a swing.
    critical = 2.0 * math.sqrt(values["contactStiffness"] * share)
    assert values["contactDamping"] / critical == pytest.approx(2.0)


def test_a_light_body_s_contacts_are_no_softer_than_that_of_three_kilograms():
    assert hardness(Surface(), False, 0.1)["contactStiffness"] == 2e5
    assert hardness(Surface(), False, 3.0)["contactStiffness"] == 2e5
    assert hardness(Surface(), False, 3.1)["contactStiffness"] > 2e5


def test_what_never_moves_is_rigid():
    assert hardness(Surface(), True, 30.0) == {}
