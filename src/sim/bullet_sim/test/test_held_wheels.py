"""Wheels that a motor holds at a speed are heavier for the solver, and for nothing else."""

import math
from dataclasses import replace

import pytest

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    PhysicsDescription,
    Plane,
    Sphere,
    Surface,
    WorldDescription,
)
from bullet_sim.physics.held_wheels import HEAVIER, SETTLING
from bullet_sim.pose import Pose
from bullet_sim.twist import Twist
from bullet_sim.world import World

RADIUS, TRACK, MASS = 0.033, 0.288, 2.1  # m, m, kg: a small robot of two wheels and a caster
OWN = 1.6e-5  # kg m^2, of a wheel about its axle
HELD = OWN + HEAVIER / 2 * MASS * RADIUS ** 2
STRONG = 10.0  # N m
SAMPLE = 50  # steps
AXLE = (0.0, 1.0, 0.0)
FLOOR = ModelDescription("floor", static=True, links=(LinkDescription("link", collisions=(
    Collision("c", Plane((0.0, 0.0, 1.0), (99.0, 99.0)), surface=Surface(mu=100.0, mu2=100.0)),)),))


LAID = Pose.from_xyz_rpy((0, 0, 0), (math.pi / 2, 0, 0))


def robot() -> ModelDescription:
    """Two wheels that carry most of it, and a ball behind them that slides."""
    base = LinkDescription(
        "base", Pose((0, 0, RADIUS)), Inertial(2.0, Pose((-0.03, 0, 0)), (0.02, 0, 0, .02, 0, .02)),
        collisions=(Collision("ball", Sphere(0.01), Pose((-0.15, 0, 0.01 - RADIUS)),
                              Surface(mu=0.1, mu2=0.1)),))
    tyre = Collision("c", Cylinder(RADIUS, 0.018), LAID, Surface(mu=0.3, mu2=0.3))
    wheels = [LinkDescription(name, Pose((0, y, RADIUS)), Inertial(0.05, inertia=(
        1.2e-5, 0, 0, OWN, 0, 1.2e-5)), collisions=(tyre,))
        for name, y in (("left", TRACK / 2), ("right", -TRACK / 2))]
    joints = [JointDescription(link.name, "continuous", "base", link.name, axis=AXLE)
              for link in wheels]
    return ModelDescription("robot", links=(base, *wheels), joints=tuple(joints))


class Rig:
    """A robot on flat ground."""

    def __init__(self, *more: ModelDescription, description: ModelDescription | None = None,
                 physics: PhysicsDescription = PhysicsDescription()):
        self.world = World(WorldDescription(models=(FLOOR, *more), physics=physics))
        self.model = self.world.spawn(description or robot())
        self.world.step(300)

    def command(self, left: float, right: float, torque: float = STRONG) -> None:
        """m/s at the rims."""
        for name, speed in (("left", left), ("right", right)):
            self.model.joints[name].drive_velocity(speed / RADIUS, torque)

    def inertia(self) -> list[float]:
        """Of both wheels about their axles, as the engine has them now, kg m^2."""
        (body,) = self.model.bodies
        return [max(body.engine.dynamics(body.joints.index[name])[2])
                for name in ("left", "right")]


@pytest.fixture
def make():
    """`make(...)`: a Rig."""
    made = []

    def rig(*args, **options):
        made.append(Rig(*args, **options))
        return made[-1]
    yield rig
    for each in made:
        each.world.close()


def test_a_wheel_is_held_once_it_has_followed_its_command(make):
    rig = make()
    assert rig.inertia() == pytest.approx([OWN, OWN])
    rig.command(0.15, 0.15)
    rig.world.step(SETTLING - 1)
    assert rig.inertia() == pytest.approx([OWN, OWN])
    rig.world.step()
    assert rig.inertia() == pytest.approx([HELD, HELD])
    rig.command(0.15, 0.15)  # the same
    rig.world.step()
    assert rig.inertia() == pytest.approx([HELD, HELD])
    rig.command(0.15, 0.2)
    assert rig.inertia() == pytest.approx([HELD, OWN])
    rig.world.step(SETTLING)
    assert rig.inertia() == pytest.approx([HELD, HELD])


def test_a_ramp_of_commands_in_every_step_is_solved_with_the_wheels_own_inertia(make):
    rig = make()
    for step in range(100):
        rig.command(0.001 * step, 0.001 * step)
        rig.world.step()
        assert rig.inertia() == pytest.approx([OWN, OWN])
    assert rig.world._client.auto_disable.is_fast  # and coarsely
    rig.world.step(SETTLING + SAMPLE)
    assert rig.inertia() == pytest.approx([HELD, HELD])


@pytest.mark.parametrize("change", [
    lambda joint: joint.drive_effort(0.01), lambda joint: joint.drive_velocity(0.0, 0.0),
    lambda joint: joint.drive_velocity(0.15 / RADIUS, 0.05)])
def test_without_a_strong_motor_it_has_its_own_inertia(make, change):
    """0.05 N m are less than half of the weight at the rim, times its friction: 0.1."""
    rig = make()
    rig.command(0.15, 0.15)
    rig.world.step(100)
    change(rig.model.joints["left"])
    rig.world.step(3 * SAMPLE)
    assert rig.inertia() == pytest.approx([OWN, HELD])


def test_a_wheel_that_runs_out_follows_the_law_of_its_own_inertia(make):
    """In the air, with a brake of known torque: alpha = torque / inertia."""
    rig = make()
    rig.model.set_pose(Pose((0.0, 0.0, 5.0)))
    wheel = rig.model.joints["left"]
    wheel.drive_velocity(100.0, STRONG)
    rig.world.step(100)
    assert rig.inertia()[0] == pytest.approx(HELD)
    wheel.drive_velocity(0.0, 0.0)
    wheel.drive_effort(-OWN * 10.0 / 0.001)  # for one step: 10 rad/s
    before = wheel.velocity
    rig.world.step()
    assert wheel.velocity - before == pytest.approx(-10.0, rel=0.01)


def test_a_wheel_that_is_blocked_is_let_go_and_held_again(make):
    rig = make()
    rig.command(0.15, 0.15)
    rig.world.step(100)
    (body,) = rig.model.bodies
    body.joints.reset("left", 0.0, -1.0)  # as by a blow
    body.wheels.sample()
    assert rig.inertia() == pytest.approx([OWN, HELD])
    rig.world.step(2 * SAMPLE)
    assert rig.inertia() == pytest.approx([HELD, HELD])


def test_a_robot_that_tilts_or_turns_fast_has_wheels_of_their_own_inertia(make):
    rig = make()
    rig.command(-0.8, 0.8)  # 5.6 rad/s
    rig.world.step(1500)
    assert rig.inertia() == pytest.approx([OWN, OWN])
    rig.command(0.15, 0.15)
    rig.world.step(500)
    assert rig.inertia() == pytest.approx([HELD, HELD])
    rig.model.bodies[0].links.set_base_frame(Pose((0.0, 0.0, 1.0)) * rig.model.pose)
    rig.model.links["base"].apply_force((0.0, 0.0, 0.0), (0.0, 8.0, 0.0))  # pitches
    rig.world.step(2 * SAMPLE)
    assert rig.inertia() == pytest.approx([OWN, OWN])


def test_while_something_else_is_fast_wheels_have_their_own_inertia(make):
    rig = make()
    ball = LinkDescription("ball", inertial=Inertial(1.0, inertia=(.004, 0, 0, .004, 0, .004)),
                           collisions=(Collision("c", Sphere(0.1)),))
    rolling = rig.world.spawn(ModelDescription("ball", links=(ball,)), Pose((0, 5.0, 0.1)))
    rolling.set_velocity(Twist((1.0, 0.0, 0.0), (0.0, 10.0, 0.0)))
    rig.command(0.15, 0.15)
    rig.world.step(2 * SAMPLE)
    assert rig.inertia() == pytest.approx([OWN, OWN])
    rig.world.delete("ball")
    rig.world.step(2 * SAMPLE)
    assert rig.inertia() == pytest.approx([HELD, HELD])


@pytest.mark.parametrize("shape, held", [
    (Cylinder(RADIUS, 0.018), True), (Sphere(RADIUS), True), (Box((0.05,) * 3), False)])
def test_what_rolls_is_held(make, shape, held):
    described = robot()
    links = tuple(
        link if link.name == "base" else replace(link, collisions=tuple(
            replace(each, geometry=shape) for each in link.collisions))
        for link in described.links)
    rig = make(description=replace(described, links=links))
    rig.model.set_pose(Pose((0.0, 0.0, 5.0)))
    rig.command(1.0, 1.0)
    rig.world.step(20)
    assert (rig.inertia()[0] > 2 * OWN) == held


def test_a_rebuilt_body_starts_with_its_own_inertia(make):
    rig = make()
    rig.command(0.15, 0.15)
    rig.world.step(100)
    base = rig.model.links["base"]
    rig.model.change_link(base, replace(base.description.inertial, mass=3.0), gravity=True)
    assert rig.inertia() == pytest.approx([OWN, OWN])
    rig.world.step(100)
    assert min(rig.inertia()) > HELD  # of a heavier robot
    rig.world.delete("robot")
    rig.world.step(100)
    assert not rig.world._client.settling


@pytest.mark.parametrize("residual, tolerances", [(None, {1e-7}), (1e-6, {1e-6})])
def test_a_world_that_says_how_exactly_is_solved_so_throughout(make, residual, tolerances):
    rig = make(physics=PhysicsDescription(residual=residual))
    seen = set()
    rig.command(0.15, 0.15)
    for _ in range(4):
        rig.world.step(100)
        seen.add(rig.world._client._tolerance)
    assert seen == tolerances
    assert rig.inertia() == pytest.approx([OWN, OWN] if residual else [HELD, HELD])


def test_what_is_no_motor_holds_nothing(make):
    """Wheels without grip and without a motor, and the brake of a joint's own dry friction."""
    described = robot()
    slippery = tuple(replace(link, collisions=tuple(replace(each, surface=Surface(mu=0.0, mu2=0.0))
                                                    for each in link.collisions))
                     for link in described.links)
    braked = tuple(replace(joint, friction=STRONG) for joint in described.joints)
    for changed in ({"links": slippery}, {"joints": braked}):
        rig = make(description=replace(described, **changed))
        rig.world.step(3 * SAMPLE)
        assert rig.inertia() == pytest.approx([OWN, OWN])


def test_gravity_that_changes_while_something_is_fast_leaves_wheels_to_be_held(make):
    rig = make()
    rig.command(0.15, 0.15)
    client = rig.world._client
    client.auto_disable.is_fast = True
    rig.world.step()
    rig.world.configure_physics(gravity=(0.0, 0.0, -9.0))
    rig.world.step(2 * SAMPLE)
    assert client._tolerance == 1e-7 and rig.inertia() == pytest.approx([HELD, HELD])


def test_velocity_decay_takes_the_wheels_own_inertia(make):
    described = robot()
    links = tuple(replace(link, angular_damping=0.1) for link in described.links)
    rig = make(description=replace(described, links=links))
    rig.command(0.15, 0.15)
    rig.world.step(100)
    assert rig.inertia() == pytest.approx([HELD, HELD])
    (body,) = rig.model.bodies
    (decay,) = [each for each in body._steady if type(each).__name__ == "VelocityDecay"]
    assert max(decay._inertia["left"][1]) == pytest.approx(OWN)


# --- errors against the exact solution, with the wheels' own inertia throughout

def driven(make, left: float, right: float, **physics) -> tuple[float, float]:
    """m and rad in 4 s after the command."""
    rig = make(physics=PhysicsDescription(**physics))
    rig.command(left, right)
    start, yaw, last = rig.model.pose.position, 0.0, 0.0
    for _ in range(40):
        rig.world.step(100)
        now = rig.model.pose.rpy()[2]
        yaw, last = yaw + math.remainder(now - last, 2 * math.pi), now
    return math.dist(rig.model.pose.position[:2], start[:2]), yaw


@pytest.mark.parametrize("left, right", [(0.15, 0.15), (0.12, 0.18), (-0.1, 0.1), (0.5, 0.5)])
def test_it_drives_closer_to_the_exact_solution_than_coarsely_solved(make, left, right):
    here = driven(make, left, right)
    coarse = driven(make, left, right, residual=1e-5)
    exact = driven(make, left, right, residual=1e-9, iterations=1000)
    assert abs(here[0] - exact[0]) <= max(abs(coarse[0] - exact[0]), 5e-5)
    assert abs(here[1] - exact[1]) <= max(abs(coarse[1] - exact[1]), 1e-4)
    assert abs(here[1] - exact[1]) < math.radians(0.05)


def test_a_driving_robot_pushes_a_box_no_harder_than_with_wheels_of_their_own(make):
    """A blow at 0.3 m/s: held wheels must not add to the momentum."""
    box = ModelDescription("box", Pose((0.3, 0.0, 0.05)), links=(LinkDescription(
        "link", inertial=Inertial(1.0, inertia=(0.002, 0, 0, 0.002, 0, 0.002)),
        collisions=(Collision("c", Box((0.1, 0.3, 0.1)), surface=Surface(mu=0.2, mu2=0.2)),)),))
    front = Collision("front", Box((0.02, 0.1, 0.02)), Pose((0.1, 0.0, 0.02)))

    def pushed(**physics) -> list[float]:
        described = robot()
        base = replace(described.links[0], collisions=(*described.links[0].collisions, front))
        rig = make(box, description=replace(described, links=(base, *described.links[1:])),
                   physics=PhysicsDescription(**physics))
        rig.command(0.3, 0.3)
        at = []
        for _ in range(30):
            rig.world.step(50)
            at.append(rig.world.models["box"].pose.position[0])
        return at
    here = pushed()
    assert here[-1] > 0.4
    assert here == pytest.approx(pushed(residual=1e-7), abs=2e-3)
