"""Springs and dampers too stiff for a step, screws, what a joint bears, `<velocity_decay>`."""

import math

import pytest
from rigs import hinge, part, rig, slider

from bullet_sim.description import (
    Inertial,
    JointAxis,
    JointDescription,
    LinkDescription,
    ModelDescription,
    WorldDescription,
)
from bullet_sim.pose import Pose, rotate
from bullet_sim.twist import Twist
from bullet_sim.world import World

G = 9.8  # m/s^2
STIFF = 1e6  # N m s or N m / rad: far more than a step can solve
UPWARD = (0.0, 0.0, 1.0)


@pytest.fixture
def spawn():
    """`spawn(model, gravity)`, at most once: the world and the model in it."""
    worlds = []

    def make(model, gravity=0.0):
        worlds.append(World(WorldDescription(gravity=(0.0, 0.0, -gravity))))
        return worlds[-1], worlds[-1].spawn(model)
    yield make
    for world in worlds:
        world.close()


def after_a_step(world, *joints) -> list[float]:
    """Their rates, of 1 before."""
    for joint in joints:
        joint.reset(0.0, 1.0)
    world.step()
    return [joint.velocity for joint in joints]


# --- springs and dampers

def test_the_hardest_damper_takes_half_the_speed_in_a_step(spawn):
    """Whatever turns on it: 0.01 kg m^2, and 1 kg 1 m beside its axis."""
    far = part("b_link", com=(1.0, 0.0, 0.0))
    world, model = spawn(rig(hinge("a", damping=STIFF), hinge("b", damping=STIFF), links=(far,)))
    assert after_a_step(world, model.joint("a"), model.joint("b")) == pytest.approx(
        [0.5, 0.5], rel=1e-3)


def test_a_hand_that_cannot_move_is_a_part_of_its_arm(spawn):
    held = JointDescription("held", "revolute", "arm_link", "hand", axis=UPWARD, lower=0.0,
                            upper=0.0)
    hand = part("hand", Pose((1.0, 0.0, 0.0)))
    world, model = spawn(rig(hinge("arm", damping=STIFF), held, links=(hand,)))
    assert after_a_step(world, model.joint("arm")) == pytest.approx([0.5], rel=0.01)


def test_beside_a_ball_joint_the_least_moment_of_inertia_counts(spawn):
    """It is safe about any axis: here 0.01 of 0.03 kg m^2, so a third of the half."""
    flat = LinkDescription("a_link", inertial=Inertial(1.0, inertia=(0.01, 0, 0, 0.02, 0, 0.03)))
    ball = JointDescription("ball", "ball", "base", "ball_link")
    world, model = spawn(rig(hinge("a", damping=STIFF), ball, links=(flat,)))
    assert after_a_step(world, model.joint("a")) == pytest.approx([1.0 - 0.5 / 3.0], rel=1e-3)


def test_the_hardest_spring_gives_back_a_tenth_of_the_way_in_a_step(spawn):
    world, model = spawn(rig(hinge("a", spring_stiffness=STIFF)))
    model.joint("a").reset(0.1)
    world.step()
    assert model.joint("a").position == pytest.approx(0.09, rel=1e-3)


# --- screws: dynamics are of the turn, though the thread takes the travel along

def screw(**options):
    """It goes 1 m for each rad: 0.01 kg m^2 turn and 1 kg travels."""
    options = {"thread_pitch": -1.0} | options
    return rig(JointDescription("j", "screw", "base", "nut", axis=UPWARD, **options))


INERTIA = 1.01  # kg m^2, with the mass that travels


def test_a_screw_is_damped_once(spawn):
    world, model = spawn(screw(damping=1.0))
    model.joint("j").reset(0.0, 1.0)
    world.step(500)
    assert model.joint("j").velocity == pytest.approx(math.exp(-0.5 / INERTIA), rel=0.01)


def test_a_screw_rubs_once(spawn):
    world, model = spawn(screw(friction=0.5))
    model.joint("j").reset(0.0, 1.0)
    world.step(500)
    assert model.joint("j").velocity == pytest.approx(1.0 - 0.5 * 0.5 / INERTIA, rel=0.01)


def test_a_screw_has_one_spring(spawn):
    world, model = spawn(screw(spring_stiffness=100.0))
    model.joint("j").reset(0.1)
    world.step(round(1000 * math.pi * math.sqrt(INERTIA / 100.0)))
    assert model.joint("j").position == pytest.approx(-0.1, rel=0.02)


def test_a_screw_s_stops_are_angles(spawn):
    world, model = spawn(screw(thread_pitch=-0.5, lower=-1.0, upper=1.0))  # 2 m for each rad
    model.joint("j").reset(0.0, 1.0)
    world.step(900)
    assert model.joint("j").position == pytest.approx(0.9, rel=0.01)
    world.step(1000)
    assert model.joint("j").position == pytest.approx(1.0, abs=0.02)


# --- gears

@pytest.mark.parametrize("ratio", [2.5, -1.5])
def test_a_planet_turns_on_its_carrier_by_the_ratio_of_the_gears(spawn, ratio):
    """The sun stands. Seen from the carrier it turns back, and the planet by that over -ratio."""
    planet = JointDescription("planet", "continuous", "carrier_link", "wheel", axis=UPWARD)
    gear = JointDescription("gear", "gearbox", "base", "wheel", axis=UPWARD,
                            axis2=JointAxis(axis=UPWARD), gearbox_ratio=ratio,
                            gearbox_reference_body="carrier_link")
    wheel = part("wheel", Pose((1.0, 0.0, 0.0)))
    world, model = spawn(rig(hinge("carrier"), planet, gear, links=(wheel,)))
    for _ in range(300):
        model.joint("carrier").drive_effort(1.0)
        world.step()
    carrier, turned = (model.joint(name).position for name in ("carrier", "planet"))
    assert carrier > 0.02
    assert turned == pytest.approx(carrier / ratio, rel=1e-2)


# --- what a joint bears

def reaction(world, joint):
    """Force and torque after a while."""
    joint.reaction()
    world.step(100)
    return joint.reaction()


def test_a_lift_bears_the_weight_that_its_motor_holds(spawn):
    world, model = spawn(rig(slider("lift", UPWARD)), G)
    model.joint("lift").drive_velocity(0.0, 100.0)
    force, torque = reaction(world, model.joint("lift"))
    assert force == pytest.approx((0.0, 0.0, -G), abs=1e-3)
    assert torque == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_loads_are_seen_from_the_child_however_its_joint_s_frame_lies(spawn):
    tilted = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.pi / 2, 0.0, 0.0))
    world, model = spawn(rig(hinge("j", pose=tilted, axis=(0.0, 1.0, 0.0))), G)
    force, _ = reaction(world, model.joint("j"))
    assert force == pytest.approx((0.0, 0.0, -G), abs=1e-3)


def test_the_load_of_a_joint_whose_parent_hangs_on_its_child(spawn):
    """Of the arm, its child, on the joint: upwards, in the arm's frame, whose x points down."""
    down = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, math.pi / 2, 0.0))
    arm = JointDescription("arm", "revolute", "base", "arm_link", axis=(1.0, 0.0, 0.0),
                           pose=Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.5, 0.0)))
    lamp = JointDescription("j", "revolute", "lamp", "arm_link", axis=(1.0, 0.0, 0.0))
    world, model = spawn(rig(arm, lamp, links=(part("arm_link", down), part("lamp"))), G)
    force, _ = reaction(world, model.joint("j"))
    assert force == pytest.approx((-G, 0.0, 0.0), abs=1e-3)


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
