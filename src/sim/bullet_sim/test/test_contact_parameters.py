"""How hard contacts are where the surface does not say so."""

import math

import pytest

from bullet_sim.description import Collision, Sphere, Surface
from bullet_sim.physics.contact_parameters import contact_values, hardness
from bullet_sim.pose import Pose

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


@pytest.mark.parametrize("kp, counts", [
    (0.99, False), (1.0, True), (1e5, True), (100_000.5, False)])
def test_a_stiffness_from_1_to_100_000_is_taken_as_told(kp, counts):
    told = {"contactStiffness": kp, "contactDamping": 7.0}
    assert (hardness(Surface(kp=kp, kd=7.0), False, 30.0) == told) == counts


def test_no_contact_has_a_damping_below_0():
    assert hardness(Surface(kp=100.0, kd=-7.0), False, 30.0)["contactDamping"] == 0.0


def test_what_bounces_is_ten_times_as_stiff_and_rises_in_half_a_second():
    values = hardness(Surface(restitution=0.5), False, 30.0)
    assert values["contactStiffness"] == pytest.approx(
        10.0 * hardness(Surface(), False, 30.0)["contactStiffness"])
    assert values["contactDamping"] / values["contactStiffness"] == pytest.approx(0.5)


# Fifteen degrees beside an axis are too far, thirteen are not.
@pytest.mark.parametrize("degrees, scale", [
    (0.0, [0.25, 0.25, 1.0]), (13.0, [0.25, 0.25, 1.0]), (15.0, None), (90.0, [1.0, 0.25, 0.25])])
def test_a_direction_of_friction_is_one_of_the_principal_axes(degrees, scale):
    """Of these the first is the link's y here, the second its z and the third its x."""
    axes = Pose((0.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5))
    placed = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, math.radians(degrees)))
    surface = Surface(mu=0.8, mu2=0.2, fdir1=(2.0, 0.0, 0.0))
    values = contact_values(Collision("c", Sphere(0.1), placed, surface), False, axes, 1.0)
    assert values["lateralFriction"] == 0.8
    assert values.get("anisotropicFriction") == (scale and pytest.approx(scale))
