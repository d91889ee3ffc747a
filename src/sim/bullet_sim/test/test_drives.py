"""Laws of drives and grippers: known answers."""

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
from bullet_sim.drives.kobuki import pressed_bumpers
from bullet_sim.mechanisms.spring_damper import rotation_vector
from bullet_sim.physics.contacts import Contact
from bullet_sim.pose import IDENTITY, Pose, quaternion_from_rpy
from bullet_sim.twist import Twist
from bullet_sim.world import World


@pytest.fixture
def world():
    made = World(WorldDescription(gravity=(0.0, 0.0, 0.0)))
    yield made
    made.close()


def cube(name: str, com=(0.0, 0.0, 0.0), static: bool = False) -> ModelDescription:
    link = LinkDescription("l", inertial=Inertial(1.0, Pose(com), (0.01, 0, 0, 0.01, 0, 0.01)),
                           collisions=(Collision("c", Box((0.1, 0.1, 0.1))),))
    return ModelDescription(name, static=static, links=(link,))


def touch(angle: float, height: float = 0.05, robot_first: bool = True) -> Contact:
    """Something touches the robot from that direction (rad in the world)."""
    normal = (-math.cos(angle), -math.sin(angle), 0.0)  # into the robot
    contact = Contact("bot::base::c", "wall::l::c", (1.0, 1.0, height), normal, 0.0, normal)
    return contact if robot_first else contact.reversed()


@pytest.mark.parametrize("robot_first", [True, False])
@pytest.mark.parametrize("degrees, height, pressed", [
    (0, 0.05, {"center"}), (29, 0.05, {"center"}), (31, 0.05, {"left"}), (89, 0.05, {"left"}),
    (91, 0.05, set()), (-31, 0.05, {"right"}), (-91, 0.05, set()), (180, 0.05, set()),
    (0, 0.005, set()), (0, 0.2, set())])
def test_a_contact_belongs_to_the_bumper_of_its_direction(degrees, height, pressed, robot_first):
    heading = 3.0  # rad: directions are the robot's, also across half a turn
    robot = Pose((1.0, 1.0, 0.0), quaternion_from_rpy(0, 0, heading))
    contact = touch(math.radians(degrees) + heading, height, robot_first)
    assert pressed_bumpers([contact], "bot::base", robot) == pressed
    assert pressed_bumpers([contact], "bot::other", robot) == set()


def test_a_rotation_vector_is_axis_times_angle_the_short_way():
    assert rotation_vector(quaternion_from_rpy(0, 0, 1.0)) == pytest.approx((0, 0, 1.0))
    assert rotation_vector(quaternion_from_rpy(0, 0, 4.0)) == pytest.approx(
        (0, 0, 4.0 - 2 * math.pi))
    assert rotation_vector(IDENTITY.orientation) == (0.0, 0.0, 0.0)


def test_set_velocity_moves_every_link_as_of_one_piece(world):
    model = world.spawn(cube("a", com=(0.03, 0.0, 0.0)))
    model.set_velocity(Twist((1.0, 0.0, 0.0), (0.0, 0.0, 2.0)))
    assert model.twist.linear == pytest.approx((1.0, 0.0, 0.0))
    assert model.twist.angular == pytest.approx((0.0, 0.0, 2.0))


def assert_same_pose(pose, expected):
    assert pose.position == pytest.approx(expected.position, abs=1e-3)
    assert pose.rpy() == pytest.approx(expected.rpy(), abs=2e-3)


def test_links_stay_attached_as_they_were_whatever_their_centres_of_mass(world):
    first = world.spawn(cube("a", (0.02, 0, 0)), Pose((0, 0, 1), quaternion_from_rpy(.3, .2, .5)))
    second = world.spawn(cube("b", (0, 0.03, 0)),
                         Pose((0.2, 0, 1.1), quaternion_from_rpy(-.3, .9, 1.5)))
    before = first.pose.inverse() * second.pose
    weld = second.links["l"].attach(first.links["l"])
    first.links["l"].apply_force((50.0, 0.0, 0.0), (0.0, 3.0, 0.0))
    world.step(300)
    assert_same_pose(first.pose.inverse() * second.pose, before)
    weld.release()
    weld.release()  # a second time does nothing


def rebuild_heavier(model):
    heavier = Inertial(2.0, Pose((0.01, 0.02, 0.0)), (0.01, 0, 0, 0.01, 0, 0.01))
    model.change_link(model.links["l"], heavier, gravity=True)


def test_a_weld_outlives_a_rebuild_of_either_body(world):
    first = world.spawn(cube("a", (0.02, 0, 0)), Pose((0, 0, 1), quaternion_from_rpy(.3, .2, .5)))
    second = world.spawn(cube("b", (0, 0.03, 0)), Pose((0.2, 0, 1.1)))
    before = first.pose.inverse() * second.pose
    weld = second.links["l"].attach(first.links["l"])
    rebuild_heavier(first)
    rebuild_heavier(second)
    first.links["l"].apply_force((50.0, 0.0, 0.0), (0.0, 3.0, 0.0))
    world.step(300)
    assert_same_pose(first.pose.inverse() * second.pose, before)
    weld.release()
    first.links["l"].apply_force((500.0, 0.0, 0.0))
    world.step(100)
    assert (first.pose.inverse() * second.pose).position != pytest.approx(before.position, abs=1e-2)


def test_what_is_held_in_the_world_can_be_moved_after_a_rebuild(world):
    model = world.spawn(cube("a", (0.02, 0, 0)), Pose((0, 0, 1)))
    hold = model.links["l"].attach()
    rebuild_heavier(model)
    for _ in range(100):
        hold.shift(Pose((0.0, 0.0, 0.001)))
        world.step()
    assert model.pose.position == pytest.approx((0.0, 0.0, 1.1), abs=5e-3)


def test_a_link_held_in_the_world_is_moved_with_what_holds_it(world):
    model = world.spawn(cube("a", (0.02, 0, 0)), Pose((0, 0, 1), quaternion_from_rpy(.3, .2, .5)))
    hold = model.links["l"].attach()
    for _ in range(100):
        hold.shift(Pose((0.0, 0.0, 0.001)))
        world.step()
    assert model.pose.position == pytest.approx((0.0, 0.0, 1.1), abs=5e-3)
    assert model.pose.rpy() == pytest.approx((0.3, 0.2, 0.5), abs=1e-3)


def test_what_is_deleted_is_let_go_before(world):
    first, second = world.spawn(cube("a")), world.spawn(cube("b"), Pose((1.0, 0, 0)))
    weld = second.links["l"].attach(first.links["l"])
    world.delete("a")
    assert not second.bodies[0].attached
    world.step(10)
    weld.release()
    second.links["l"].attach(world.spawn(cube("s", static=True)).links["l"])
    world.delete("s")
    world.step(10)
    assert second.pose.position == pytest.approx((1.0, 0.0, 0.0), abs=1e-3)


@pytest.mark.parametrize("static", [False, True])
def test_links_of_one_model_can_be_welded_and_the_model_deleted(world, static):
    left, right = cube("l").links[0], cube("r").links[0]
    right = replace(right, name="r", pose=Pose((0.5, 0.0, 0.0)))
    model = world.spawn(ModelDescription("m", static=static, links=(left, right)))
    removed = []
    world.each_removal.append(removed.append)
    weld = model.links["l"].attach(model.links["r"])
    bodies = list(model.bodies)
    world.delete("m")
    assert removed == ["m"] and not world.models
    assert not any(body.is_loaded for body in bodies)
    weld.release()


def test_links_of_one_body_can_be_welded_and_the_model_deleted(world):
    left, right = cube("l").links[0], cube("r").links[0]
    right = replace(right, name="r", pose=Pose((0.5, 0.0, 0.0)))
    hinge = JointDescription("j", "revolute", "l", "r", axis=(0.0, 0.0, 1.0))
    model = world.spawn(ModelDescription("m", links=(left, right), joints=(hinge,)))
    model.links["l"].attach(model.links["r"])
    (body,) = model.bodies
    model.joints["j"].drive_effort(1.0)
    world.step(100)
    assert model.joints["j"].position == pytest.approx(0.0, abs=1e-2)
    rebuild_heavier(model)
    assert len(body.attached) == 1
    world.delete("m")
    assert not body.is_loaded


def test_every_removal_is_told_though_one_fails(world):
    model, removed = world.spawn(cube("a")), []

    def fail(name):
        raise ValueError(name)

    world.each_removal += [fail, removed.append]
    with pytest.raises(ValueError, match="a"):
        world.delete("a")
    assert removed == ["a"] and not model.bodies[0].is_loaded


def test_models_that_were_welded_after_they_moved_stand_still_after_a_reset(world):
    first, second = world.spawn(cube("a")), world.spawn(cube("b"), Pose((1.0, 0.0, 0.0)))
    second.set_pose(Pose((0.2, 0.0, 0.0)))
    second.links["l"].attach(first.links["l"])
    world.step(10)
    world.reset_models()
    for _ in range(200):
        world.step()
        assert all(abs(part) < 1e-3 for model in (first, second) for part in model.twist.linear)
    first.links["l"].apply_force((0.0, 50.0, 0.0))
    world.step(300)
    assert_same_pose(first.pose.inverse() * second.pose, Pose((1.0, 0.0, 0.0)))  # still welded


def test_what_hangs_in_the_world_stays_where_a_reset_puts_it(world):
    model = world.spawn(cube("a"))
    hold = model.links["l"].attach()
    hold.shift(Pose((0.0, 0.0, 1.0)))
    world.step(2000)
    world.reset_models()
    world.step(500)
    assert_same_pose(model.pose, Pose())
