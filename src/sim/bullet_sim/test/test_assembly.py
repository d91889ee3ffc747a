"""Joints that are no plain tree: what the engine gets."""

import math

import pytest

from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.physics.assembly import assemble

GRAVITY = 9.8
ROD = """<inertial><mass>1</mass><inertia><ixx>0.08333333</ixx><iyy>0.08333333</iyy>
    <izz>0.0001</izz></inertia></inertial>"""


def read(body: str):
    text = f'<sdf version="1.6"><model name="m">{body}</model></sdf>'
    return load_model(text, Resources())


def links(names: str) -> str:
    return "".join(f'<link name="{name}">{ROD}</link>' for name in names)


def joint(name: str, parent: str, child: str, kind: str = "revolute", more: str = "") -> str:
    return (f'<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child>'
            f"{more}</joint>")


def carried(tree) -> dict[str, str | None]:
    return {link.name: link.parent for link in tree.links}


def test_a_joint_whose_child_is_the_world_is_turned_round(world):
    """The pendulum's rod, held at its upper end by a joint that is written the other way."""
    pivot = "<pose>0 0 2.5 0 0 0</pose><axis><xyz>0 1 0</xyz></axis>"  # in the child, the world
    model = world.spawn(read(f'<link name="arm"><pose>0 0 2 0 0 0</pose>{ROD}</link>'
                             + joint("hinge", "arm", "world", more=pivot)))
    model.joint("hinge").reset(math.pi / 2)
    # The world turned by a quarter about the arm's y: the arm by minus a quarter about the world's.
    assert model.links["arm"].pose.position == pytest.approx((0.5, 0.0, 2.5), abs=1e-6)
    for _ in range(10):
        world.step()
    # A rod of length L let go level turns with 3 g / (2 L).
    assert model.joint("hinge").velocity == pytest.approx(-1.5 * GRAVITY * 0.01, rel=0.01)


def test_a_fixed_joint_to_the_world_holds_either_way_round():
    for ends in (("world", "a"), ("a", "world")):
        (tree,) = assemble(read(links("a") + joint("j", *ends, kind="fixed")))
        assert tree.fixed
        assert [(link.name, link.parent, link.joint) for link in tree.links] == [("a", None, None)]


def test_a_link_that_two_joints_carry_is_no_loop(caplog):
    (tree,) = assemble(read(links("abc") + joint("j", "a", "b") + joint("k", "c", "b")))
    assert carried(tree) == {"a": None, "b": "a", "c": "b"}
    assert tree.links[2].joint.axis == (0, 0, -1)
    assert not caplog.records


def test_what_the_world_holds_is_the_base():
    (tree,) = assemble(read(links("ab") + joint("j", "a", "b")
                            + joint("k", "world", "b", kind="fixed")))
    assert tree.fixed
    assert carried(tree) == {"b": None, "a": "b"}


def test_a_ring_of_joints_is_closed_without_a_warning(world, caplog):
    ring = links("abc") + joint("j", "a", "b") + joint("k", "b", "c") + joint("l", "c", "a")
    model = world.spawn(read(ring))
    assert list(model.joints) == ["j", "l", "k"]
    assert not caplog.records


def test_a_fixed_joint_is_none_that_can_move(world, caplog):
    model = world.spawn(read(links("abc") + joint("j", "a", "b", kind="fixed")
                             + joint("k", "b", "c")))
    assert list(model.joints) == ["k"]
    assert not caplog.records


def test_a_static_model_is_in_as_few_pieces_of_128_parts_as_can_be():
    """A link of one surface, and 200 of two: what belongs to a link stays in one piece."""
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    smooth = f'<collision name="smooth">{box}</collision>'
    rough = (f'<collision name="rough">{box}<surface><friction><ode><mu>5</mu></ode></friction>'
             "</surface></collision>")
    trees = assemble(read(f'<static>true</static><link name="one">{smooth}</link>' + "".join(
        f'<link name="{number}">{smooth}{rough}</link>' for number in range(200))))
    assert [len(tree.links) for tree in trees] == [127, 128, 128, 18]


def test_velocity_decay_reaches_the_engines_links():
    (tree,) = assemble(read(f"""<link name="a">{ROD}<velocity_decay><linear>0.5</linear>
        <angular>0.25</angular></velocity_decay></link>"""))
    assert (tree.links[0].linear_damping, tree.links[0].angular_damping) == (0.5, 0.25)
