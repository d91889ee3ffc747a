"""Models inside models: whose a part is, where the frames are, and what names find."""

import pytest
from rigs import body, hinge, part

from bullet_sim.description import ModelDescription, WorldDescription
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.nested import NestedModel, find_frame, find_nested_model
from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.twist import STILL, Twist
from bullet_sim.world import World

ARM, HAND, EMPTY = "arm", "arm::hand", "empty"
TURNED = quaternion_from_rpy(0.0, 0.0, 1.0)


def robot(static: bool = False) -> ModelDescription:
    """A base with an arm that turns on it; a hand that is free is nested in the arm."""
    turn = hinge("arm::turn")
    return ModelDescription(
        "robot", static=static,
        links=(part("base"), part("arm::turn_link", Pose((1.0, 0.0, 0.0))),
               part("arm::hand::l", Pose((3.0, 0.0, 0.0)))),
        joints=(turn,), child_models=(ARM, HAND, EMPTY),
        child_poses={ARM: Pose((1.0, 0.5, 0.0)), HAND: Pose((2.0, 0.0, 0.0)),
                     EMPTY: Pose((0.0, 4.0, 0.0))})


@pytest.fixture
def world():
    made = World(WorldDescription(gravity=(0.0, 0.0, 0.0)))
    made.spawn(robot(), Pose((0.0, 0.0, 10.0)))
    yield made
    made.close()


@pytest.mark.parametrize("name, parent, children, links, joints", [
    ("", "", [ARM, EMPTY], ["base"], []),
    (ARM, "robot", ["hand"], ["arm::turn_link"], ["arm::turn"]),
    (HAND, "arm", [], ["arm::hand::l"], []),
    (EMPTY, "robot", [], [], [])])
def test_each_model_has_its_own_parts(world, name, parent, children, links, joints):
    nested = NestedModel(world.models["robot"], name)
    assert nested.parent_name == parent
    assert nested.child_names == children
    assert [link.name for link in nested.links()] == links
    assert [joint.name for joint in nested.joints()] == joints
    assert [nested.unscoped(link) for link in links] == [link.split("::")[-1] for link in links]


def test_frames_go_along_with_their_first_link(world):
    model = world.models["robot"]
    model.joints["arm::turn"].reset(1.0)  # about (1, 0): the frame of the arm is 0.5 m beside it
    pose = NestedModel(model, ARM).pose
    turned = Pose((1.0, 0.0, 10.0), TURNED) * Pose((0.0, 0.5, 0.0))
    assert pose.position == pytest.approx(turned.position)
    assert pose.rpy()[2] == pytest.approx(1.0)
    assert NestedModel(model, HAND).pose.position == pytest.approx((2.0, 0.0, 10.0))
    assert NestedModel(model, EMPTY).pose.position == pytest.approx((0.0, 4.0, 10.0))
    assert NestedModel(model).pose == model.pose


def test_frames_move_with_their_first_link(world):
    model = world.models["robot"]
    model.joints["arm::turn"].reset(0.0, 2.0)
    arm = NestedModel(model, ARM)
    assert arm.twist.angular == pytest.approx((0.0, 0.0, 2.0))
    assert arm.twist.linear == pytest.approx((-1.0, 0.0, 0.0))  # 0.5 m from the axis
    assert NestedModel(model, EMPTY).twist == STILL
    model.set_velocity(Twist((0.0, 0.0, 3.0)))
    assert NestedModel(model).twist.linear == pytest.approx((0.0, 0.0, 3.0))


def test_what_is_static_is_still(world):
    fixed = world.spawn(robot(static=True), name="statue")
    assert NestedModel(fixed, ARM).twist == STILL


@pytest.mark.parametrize("name, found", [
    ("robot", ""), ("robot::arm", ARM), ("arm", ARM), ("hand", HAND), ("robot::arm::hand", HAND)])
def test_nested_models_are_found_scoped_or_not(world, name, found):
    assert find_nested_model(world.models.values(), name).name == found


def test_a_model_comes_before_a_nested_one_of_its_name(world):
    world.spawn(body("arm"))
    assert find_nested_model(world.models.values(), "arm").model.name == "arm"
    assert find_nested_model(world.models.values(), "leg") is None


# --- names of links and frames

def test_a_link_is_found_by_scoped_name_or_by_one_that_is_unique(world):
    world.spawn(body("box"))
    assert world.link("box::l").scoped_name == "box::l"
    assert world.link("robot::arm::hand::l").name == "arm::hand::l"
    assert world.link("base").model.name == "robot"
    world.spawn(body("other"))
    with pytest.raises(UnknownName, match="no link named 'l'; there are: robot::base, "):
        world.link("l")
    with pytest.raises(UnknownName, match="no link of model box named 'm'; there are: l"):
        world.link("box::m")


def test_the_longest_name_of_a_model_wins(world):
    assert world.link("robot::arm::turn_link").model.name == "robot"
    world.spawn(ModelDescription("robot::arm", links=(part("turn_link"),)))
    assert world.link("robot::arm::turn_link").model.name == "robot::arm"
    assert world.link("robot::base").model.name == "robot"


@pytest.mark.parametrize("name", ["", "world", "map", "/map"])
def test_the_world_is_a_frame_of_these_names(world, name):
    assert find_frame(world.models, name) == (Pose(), Twist())


def test_frames_are_models_nested_ones_and_links(world):
    assert find_frame(world.models, "robot")[0].position == (0.0, 0.0, 10.0)
    assert find_frame(world.models, "hand")[0].position == pytest.approx((2.0, 0.0, 10.0))
    assert find_frame(world.models, "base")[0].position == pytest.approx((0.0, 0.0, 10.0))
    with pytest.raises(UnknownName, match="no link named 'nowhere'"):
        find_frame(world.models, "nowhere")


def test_a_joint_of_a_static_model_says_why_it_is_not_there(world):
    fixed = world.spawn(robot(static=True), name="statue")
    with pytest.raises(SimulationError, match="does not move, as model statue is static; remove"):
        fixed.joint("arm::turn")
    with pytest.raises(UnknownName, match="no joint of model statue named 'elbow'"):
        fixed.joint("elbow")
