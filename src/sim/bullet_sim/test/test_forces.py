"""Wrenches and efforts that act for a while, and bodies whose masses and stops are changed."""

import math
from dataclasses import replace

import pytest

from bullet_sim.description import (
    Box,
    Collision,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    WorldDescription,
)
from bullet_sim.pose import Pose
from bullet_sim.timed_forces import Effort, Span, Wrench
from bullet_sim.twist import Twist
from bullet_sim.world import World

INERTIA = (0.1, 0.0, 0.0, 0.2, 0.0, 0.3)
BOX = ModelDescription("box", links=(
    LinkDescription("body", inertial=Inertial(2.0, inertia=INERTIA)),))
HINGE = ModelDescription("arm", links=(
    LinkDescription("base", inertial=Inertial(5.0)),
    LinkDescription("tip", inertial=Inertial(1.0, inertia=INERTIA), gravity=False)), joints=(
        JointDescription("root", "fixed", "world", "base"),
        JointDescription("hinge", "revolute", "base", "tip", effort=3.0)))


def space(*models, gravity=(0.0, 0.0, 0.0)) -> World:
    world = World(WorldDescription(gravity=gravity))
    for model in models:
        world.spawn(model)
    return world


def near(values):
    return pytest.approx(values, abs=1e-6)


def test_a_force_for_a_tenth_of_a_second():
    world = space(BOX)
    link = world.link("box::body")
    world.forces.wrenches.append(Wrench(link, (4.0, 0, 0), (0, 0, 0), Span(0.0, 0.1)))
    world.step(300)
    assert link.twist.linear == near((4.0 * 0.1 / 2.0, 0, 0))
    assert not world.forces


def test_a_force_alone_turns_nothing():
    world = space(BOX)
    link = world.link("box::body")
    link.apply_force((2.0, 0.0, 0.0))
    world.step()
    assert link.twist.linear == near((world.timestep, 0, 0))
    assert link.twist.angular == (0.0, 0.0, 0.0)


def test_a_torque_turns_about_world_axes_however_the_body_lies():
    world = space()
    link = world.spawn(BOX, Pose.from_xyz_rpy((0, 0, 0), (0, math.pi / 2, 0))).links["body"]
    world.forces.wrenches.append(Wrench(link, (0, 0, 0), (0, 0, 0.5), Span(0.0, 0.1)))
    world.step(200)
    # the body's x axis points down, so it is ixx = 0.1 that resists
    assert link.twist.angular == pytest.approx((0, 0, 0.5), abs=1e-3)


def test_the_last_wrench_on_a_link_is_felt_until_it_ends():
    world = space(BOX)
    link = world.link("box::body")
    for force, duration in ((1.0, -1.0), (4.0, 0.1)):
        world.forces.wrenches.append(Wrench(link, (force, 0, 0), (0, 0, 0), Span(0.0, duration)))
    world.step(100)
    assert link.twist.linear[0] == near(0.2)
    world.step(100)
    assert link.twist.linear[0] == near(0.25)
    world.forces.drop(lambda job: job.link is link)
    world.step(100)
    assert link.twist.linear[0] == near(0.25)


def test_a_force_that_begins_later_wakes_a_world_at_rest():
    world = space(BOX)
    world.step(2000)
    link = world.link("box::body")
    world.forces.wrenches.append(Wrench(link, (2.0, 0, 0), (0, 0, 0), Span(3.0, -1.0)))
    world.step(999)
    assert link.twist.linear[0] == 0.0
    world.step(11)
    assert link.twist.linear[0] == near(0.011)


def test_efforts_on_a_joint_add_up_and_are_cut_to_its_limit():
    world = space(HINGE)
    model = world.model("arm")
    joint = model.joint("hinge")
    for effort in (1.0, 9.0):
        world.forces.efforts.append(Effort(model, joint, effort, Span(0.0, 0.01)))
    world.step(50)
    assert joint.velocity == pytest.approx((1.0 + 3.0) * 0.01 / 0.3, rel=1e-3)


def test_forces_go_with_their_model():
    world = space(BOX)
    world.forces.wrenches.append(
        Wrench(world.link("box::body"), (1.0, 0, 0), (0, 0, 0), Span(0.0, -1.0)))
    world.delete("box")
    assert not world.forces


def test_other_masses_in_full_motion():
    world = space(BOX)
    model = world.model("box")
    link = model.links["body"]
    model.set_twist(Twist((1.0, 0, 0), (0, 0, 2.0)))
    before = link.pose
    model.change_link(link, Inertial(4.0, Pose((0.5, 0, 0)), INERTIA), gravity=True)
    assert link.pose.position == near(before.position)
    assert link.twist.linear == near((1.0, 0, 0)) and link.twist.angular == near((0, 0, 2.0))
    model.set_twist(Twist())
    world.forces.wrenches.append(Wrench(link, (4.0, 0, 0), (0, 0, 0), Span(0.0, 0.1)))
    world.step(100)
    assert link.twist.linear == near((0.1, 0, 0))  # through the centre of mass: no turn
    world.forces.wrenches.append(Wrench(link, (0, 0, 0), (0, 0, 0.3), Span(0.1, 0.1)))
    world.step(100)
    # it turns about its centre of mass, half a metre ahead of the link's origin
    assert link.twist.angular[2] == pytest.approx(0.1, rel=1e-3)
    assert link.twist.linear[1] == pytest.approx(-0.05, rel=1e-2)


def test_gravity_can_be_switched_off_and_on():
    world = space(BOX, gravity=(0, 0, -10.0))
    model = world.model("box")
    link = model.links["body"]
    model.change_link(link, link.description.inertial, gravity=False)
    world.step(100)
    assert link.twist.linear[2] == near(0.0)
    model.change_link(link, link.description.inertial, gravity=True)
    world.step(100)
    assert link.twist.linear[2] == near(-1.0)


def test_stops_and_damping_of_a_joint_that_moves():
    world = space(HINGE)
    joint = world.model("arm").joint("hinge")
    joint.reset(0.1, 1.0)
    joint.change(-0.5, 0.5, 0.0)
    assert (joint.position, joint.velocity) == near((0.1, 1.0))
    world.step(1000)
    assert joint.position == pytest.approx(0.5, abs=0.02)
    joint.reset(0.0, 1.0)
    joint.change(1.0, -1.0, 0.6)  # the wrong way round: no stops
    world.step(3000)
    assert joint.position == pytest.approx(0.3 / 0.6, rel=0.02)  # inertia x rate / damping


def test_motors_and_what_lasers_see_outlive_a_change():
    bright = Collision("c", Box((1, 1, 1)), laser_retro=7.0)
    lamp = ModelDescription("lamp", links=(replace(BOX.links[0], collisions=(bright,)),))
    world = space(HINGE, lamp)
    model = world.model("arm")
    group = model.joint_groups(["hinge"])[0]
    model.joint("hinge").drive_velocity(0.5, 10.0)
    for name in ("arm::tip", "lamp::body"):
        link = world.link(name)
        world.model(link.model.name).change_link(
            link, Inertial(2.0, inertia=INERTIA), gravity=False)
    world.step(50)
    assert group.states()[0][1] == pytest.approx(0.5, abs=1e-3)
    assert len(world._client.retro) == 1


def test_a_link_is_put_somewhere_with_its_joints():
    world = space(replace(HINGE, joints=HINGE.joints[1:]))
    model = world.model("arm")
    joint, tip = model.joint("hinge"), model.links["tip"]
    joint.reset(0.5, 0.25)
    model.move_link(tip, Pose((1.0, 2.0, 3.0)), Twist((0.1, 0, 0), (0, 0, 1.0)))
    assert tip.pose.position == near((1.0, 2.0, 3.0)) and tip.pose.rpy() == near((0, 0, 0))
    assert tip.twist.linear == near((0.1, 0, 0)) and tip.twist.angular == near((0, 0, 1.0))
    assert (joint.position, joint.velocity) == near((0.5, 0.25))
