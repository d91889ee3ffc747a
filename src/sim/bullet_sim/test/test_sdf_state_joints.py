"""Joints of saved worlds: where `<state>` has their links."""

import pytest

from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.world import World

DOOR = """<model name="door">
    <link name="frame"><pose>0 0 1 0 0 0</pose></link>
    <link name="leaf"><pose>0.5 0 1 0 0 0</pose></link>
    <link name="bolt"><pose>0.5 0 2 0 0 0</pose></link>
    <joint name="hinge" type="revolute"><parent>frame</parent><child>leaf</child>
      <pose>-0.5 0 0 0 0 0</pose><axis><xyz>0 0 2</xyz>
        <limit><lower>{lower}</lower><upper>3</upper></limit></axis></joint>
    <joint name="slide" type="prismatic"><parent>leaf</parent><child>bolt</child>
      <axis><xyz>0 1 0</xyz></axis></joint></model>
    <state world_name="default"><model name="door"><pose>4 0 0 0 0 1.5708</pose>
      <link name="frame"><pose>4 0 1 0 0 1.5708</pose></link>
      <link name="leaf"><pose>4.5 0 1 0 0 0</pose></link>
      <link name="bolt"><pose>4.5 0.1 2 0 0 0</pose></link></model></state>"""


@pytest.fixture
def state_of(tmp_path):
    """`state_of(lower)`: the saved door, whose hinge has that lower limit (rad)."""
    def read(lower):
        path = tmp_path / "door.world"
        path.write_text(f'<sdf version="1.6"><world name="w">{DOOR.format(lower=lower)}'
                        "</world></sdf>", encoding="utf-8")
        return load_world(path, Resources())
    return read


@pytest.mark.parametrize("lower, hinge", [(-3.0, -1.5708), (-1.0, -1.0)])
def test_state_of_links_is_that_of_joints(state_of, lower, hinge):
    # conforms: sdf state/model/link
    model = state_of(lower).models[0]
    assert [joint.start for joint in model.joints] == pytest.approx([hinge, 0.1], abs=1e-4)
    assert model.links[1].pose.position == (0.5, 0, 1)  # where the joint is at zero


def test_a_saved_model_starts_with_its_joints_as_saved_and_is_reset_to_zero(state_of):
    world = World(state_of(-3.0))
    door = world.model("door")
    assert door.pose.position == pytest.approx((4, 0, 0), abs=1e-6)
    assert door.link("leaf").pose.position == pytest.approx((4.5, 0, 1), abs=1e-4)
    assert door.link("bolt").pose.position == pytest.approx((4.5, 0.1, 2), abs=1e-4)
    world.reset_models()
    assert door.joint("hinge").position == door.joint("slide").position == 0.0
    world.close()
