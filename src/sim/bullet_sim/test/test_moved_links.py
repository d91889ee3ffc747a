"""A link that joints hold to the world is put where its joint can bring it."""

import math
from dataclasses import replace

import pytest
from rigs import hinge, part, rig, slider

from bullet_sim.description import JointDescription, WorldDescription
from bullet_sim.pose import Pose
from bullet_sim.twist import Twist
from bullet_sim.world import World


@pytest.fixture
def spawn():
    """Into a world without gravity."""
    world = World(WorldDescription(gravity=(0.0, 0.0, 0.0)))
    yield world.spawn
    world.close()


def turned(angle: float, radius: float = 0.0) -> Pose:
    """By so much, rad, about z, at that distance, m, from it."""
    return Pose.from_xyz_rpy((radius * math.cos(angle), radius * math.sin(angle), 0.0),
                             (0.0, 0.0, angle))


def test_a_hinge_turns_to_the_pose_and_at_the_rate(spawn):
    model = spawn(rig(hinge("j", lower=-1.0, upper=1.0)))
    joint, tip = model.joint("j"), model.links["j_link"]
    model.move_link(tip, turned(0.5), Twist((0.0, 0.0, 0.0), (3.0, 0.0, 2.0)))
    assert (joint.position, joint.velocity) == pytest.approx((0.5, 2.0))
    model.move_link(tip, turned(-2.0), Twist())
    assert (joint.position, joint.velocity) == pytest.approx((-1.0, 0.0))  # its stop


def test_a_joint_that_is_put_somewhere_stands_there(spawn):
    model = spawn(rig(hinge("j")))
    model.joint("j").reset(0.1, 3.0)
    model.joint("j").reset(0.25)
    assert (model.joint("j").position, model.joint("j").velocity) == (0.25, 0.0)


def test_a_slider_goes_to_the_foot_of_the_perpendicular(spawn):
    model = spawn(rig(slider("j", (0.0, 1.0, 0.0))))
    model.move_link(model.links["j_link"], Pose((5.0, 0.25, 7.0)), Twist((1.0, 2.0, 3.0)))
    assert (model.joint("j").position, model.joint("j").velocity) == pytest.approx((0.25, 2.0))


def test_a_joint_turns_from_where_the_one_before_it_is(spawn):
    """Twist and pose are the world's, its own are what the arm does not do already."""
    fore = JointDescription("fore", "revolute", "arm_link", "fore_link", axis=(0.0, 0.0, 1.0))
    model = spawn(rig(hinge("arm"), fore))
    model.joint("arm").reset(0.3, 0.5)
    model.move_link(model.links["fore_link"], turned(1.0), Twist((0, 0, 0), (0, 0, 2.0)))
    assert (model.joint("fore").position, model.joint("fore").velocity) == pytest.approx((0.7, 1.5))
    assert (model.joint("arm").position, model.joint("arm").velocity) == pytest.approx((0.3, 0.5))


@pytest.mark.parametrize("kind", ["fixed", "revolute"])
def test_what_is_fixed_to_an_arm_takes_the_arm_along(spawn, kind):
    """A joint whose both stops are at 0 is one that does not move."""
    held = JointDescription("held", kind, "arm_link", "hand", lower=0.0, upper=0.0)
    model = spawn(rig(hinge("arm"), held, links=(part("hand", Pose((1.0, 0.0, 0.0))),)))
    model.move_link(model.links["hand"], turned(0.5, 1.0), Twist())
    assert model.joint("arm").position == pytest.approx(0.5)


def test_what_hangs_on_a_ball_or_in_the_world_stays(spawn):
    ball = replace(hinge("ball"), type="ball")
    model = spawn(rig(ball))
    for name in ("ball_link", "base"):
        before = model.links[name].pose
        model.move_link(model.links[name], turned(0.5), Twist())
        assert model.links[name].pose.rpy() == pytest.approx(before.rpy())
