"""Which casters are put up to the wheels' ground, and how wheels are shaped for the engine."""

import math
from dataclasses import replace

import pytest
import trimesh

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointDescription,
    LinkDescription,
    Mesh,
    ModelDescription,
    Plane,
    Sphere,
    Surface,
    WorldDescription,
)
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.physics.assembly import assemble
from bullet_sim.physics.levelling import CLEARANCE, levelled
from bullet_sim.physics.tyres import TREAD, crown, engine_shapes, find_tyre
from bullet_sim.pose import Pose
from bullet_sim.world import World

LAYER = 1e-3  # m
LIGHT = Inertial(1.0, inertia=(0.01, 0, 0, 0.01, 0, 0.01))
BALL = Sphere(0.02)  # m; it stands on the wheels' ground at that height
AXLE, TRAVEL = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
SWIVEL = (0.0, 0.0, 1.0)


def caster(name: str, x: float, low: float, shape=BALL, mu: float = 1.0, turn: float = 0.0):
    """Its bottom is `low` (m) below the wheels'."""
    pose = Pose.from_xyz_rpy((x, 0.0, 0.02 - low), (0.0, 0.0, turn))
    return LinkDescription(name, pose=pose, inertial=LIGHT,
                           collisions=(Collision("c", shape, surface=Surface(mu=mu, mu2=mu)),))


def tree_of(*casters: LinkDescription, wheel_type="continuous", axis=AXLE, caster_type="fixed",
            caster_axis=AXLE, more=(), yaw=0.0):
    """A base of some height, two wheels, and the casters on joints of that type, or of `more`."""
    tyre = Collision("c", Cylinder(0.05, 0.03), Pose.from_xyz_rpy((0, 0, 0), (-math.pi / 2, 0, 0)),
                     Surface(mu=1.0, mu2=1.0))
    wheels = [LinkDescription(name, pose=Pose((0.0, y, 0.05)), inertial=LIGHT, collisions=(tyre,))
              for name, y in (("left", 0.1), ("right", -0.1))]
    joints = [JointDescription(w.name, wheel_type, "base", w.name, axis=axis) for w in wheels]
    joints += [JointDescription(c.name, caster_type, "base", c.name, axis=caster_axis)
               for c in casters if c.name not in [joint.child for joint in more]]
    joints += more
    turn = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, yaw))
    links = (replace(link, pose=turn * link.pose)
             for link in (LinkDescription("base", inertial=LIGHT), *wheels, *casters))
    (tree,) = assemble(ModelDescription("m", links=tuple(links), joints=tuple(joints)))
    return tree


def raised(tree, layer=LAYER) -> dict[str, float]:
    """How far each changed collision's frame went up, m, after the link that it belongs to."""
    changes = {}
    for before, after in zip(tree.links, levelled(tree, layer).links, strict=True):
        for old, new in zip(before.collisions, after.collisions, strict=True):
            if old != new:
                changes[before.name] = new.pose.position[2] - old.pose.position[2]
    return changes


def test_casters_before_and_behind_come_up_to_the_wheels():
    tree = tree_of(caster("front", 0.1, 1e-3), caster("back", -0.1, 3e-4, turn=1.0))
    assert raised(tree) == {"front": pytest.approx(1e-3 + CLEARANCE),
                            "back": pytest.approx(3e-4 + CLEARANCE)}


@pytest.mark.parametrize("yaw", [0.5, 2.0])
def test_they_are_before_and_behind_whichever_way_the_wheels_face(yaw):
    post = caster("front", 0.1, 0.0, Cylinder(0.01, 0.04))
    assert set(raised(tree_of(post, caster("back", -0.1, 0.0), yaw=yaw))) == {"front", "back"}
    assert raised(tree_of(post, caster("other", 0.15, 0.0), yaw=yaw)) == {}


def test_the_bottom_of_each_shape_is_known():
    lying = Cylinder(0.02, 0.1)
    tree = tree_of(caster("front", 0.1, 0.0, Box((0.02, 0.02, 0.04))),
                   caster("back", -0.1, -0.01, Cylinder(0.01, 0.06)))
    assert raised(tree) == {"front": pytest.approx(CLEARANCE), "back": pytest.approx(CLEARANCE)}
    lain = caster("front", 0.1, 0.0, lying)
    rolled = LinkDescription("front", pose=Pose.from_xyz_rpy((0.1, 0, 0.02), (math.pi / 2, 0, 0)),
                             inertial=LIGHT, collisions=lain.collisions)
    changed = levelled(tree_of(rolled, caster("back", -0.1, 0.0)), LAYER).links[3].collisions[0]
    assert changed.pose.position == pytest.approx((0.0, CLEARANCE, 0.0))  # its y points up


@pytest.mark.parametrize("casters", [
    [caster("back", -0.1, 3e-4), caster("other", -0.15, 3e-4)],  # three support it anyhow
    [caster("front", 0.1, 3e-4), caster("back", -0.1, 1.2e-3)],  # deeper than the layer
    [caster("front", 0.1, 3e-4), caster("back", -0.1, -1e-3)],  # well above
])
def test_robots_whose_wheels_carry_stay_as_described(casters):
    assert raised(tree_of(*casters)) == {}


def test_the_layer_decides_and_is_no_thicker_than_a_millimetre():
    pair = [caster("front", 0.1, 3e-4), caster("back", -0.1, 3e-4)]
    assert set(raised(tree_of(*pair), 3e-4)) == {"front", "back"}
    assert raised(tree_of(*pair), 2e-4) == {}
    assert raised(tree_of(caster("front", 0.1, 2e-3), caster("back", -0.1, 2e-3)), 0.01) == {}


def test_without_wheels_on_level_axles_nothing_is_levelled():
    pair = [caster("front", 0.1, 3e-4), caster("back", -0.1, 3e-4)]
    assert raised(tree_of(*pair, axis=SWIVEL)) == {}
    assert raised(tree_of(*pair, axis=(0.0, 1.0, 0.15))) == {}
    assert set(raised(tree_of(*pair, axis=(0.0, 1.0, 0.05)))) == {"front", "back"}
    assert raised(tree_of(*pair, wheel_type="prismatic", axis=TRAVEL)) == {}
    assert raised(tree_of(*pair, wheel_type="fixed")) == {}


def test_what_never_moves_is_not_levelled():
    tree = tree_of(caster("front", 0.1, 3e-4), caster("back", -0.1, 3e-4))
    assert raised(replace(tree, fixed=True)) == {}


@pytest.mark.parametrize("mu, smaller", [(0.5, True), (0.51, False)])
def test_what_has_half_the_grip_of_the_wheels_is_a_caster(mu, smaller):
    pair = [caster("front", 0.1, 3e-4, mu=mu), caster("back", -0.1, 3e-4, mu=mu)]
    after = levelled(tree_of(*pair, caster_type="continuous"), LAYER).links[3].collisions[0]
    assert (after.geometry.radius < BALL.radius) == smaller


def test_slippery_balls_on_axles_are_casters_and_get_smaller():
    pair = [caster("front", 0.1, 3e-4, mu=0.0), caster("back", -0.1, 3e-4, mu=0.0)]
    after = levelled(tree_of(*pair, caster_type="continuous"), LAYER).links[3].collisions[0]
    assert after.geometry.radius == pytest.approx(BALL.radius - 3e-4 - CLEARANCE)
    assert after.pose == Pose()
    gripping = [caster("front", 0.1, 3e-4), caster("back", -0.1, 3e-4)]
    assert raised(tree_of(*gripping, caster_type="continuous")) == {}  # wheels, too


@pytest.mark.parametrize("mu", [0.0, 1.0])
def test_balls_that_turn_any_way_stay_centred_and_get_smaller(mu):
    pair = [caster("front", 0.1, 3e-4, mu=mu), caster("back", -0.1, 3e-4, mu=mu)]
    after = levelled(tree_of(*pair, caster_type="ball"), LAYER).links[3:]
    for link in after:
        (ball,) = link.collisions
        assert ball.geometry.radius == pytest.approx(BALL.radius - 3e-4 - CLEARANCE)
        assert ball.pose == Pose()


def off_centre(link: LinkDescription, by: float) -> LinkDescription:
    """Its shape stays where it is; its frame and joint are so much higher (m)."""
    (shape,) = link.collisions
    return replace(link, pose=link.pose * Pose((0.0, 0.0, by)),
                   collisions=(replace(shape, pose=Pose((0.0, 0.0, -by))),))


@pytest.mark.parametrize("shape, by", [(Box((0.04, 0.04, 0.04)), 0.0), (BALL, 0.01)])
def test_what_hangs_on_a_ball_joint_and_does_not_roll_comes_up_as_it_is(shape, by):
    pair = [off_centre(caster(name, x, 3e-4, shape), by) for name, x in (("a", 0.1), ("b", -0.1))]
    assert raised(tree_of(*pair, caster_type="ball")) == {
        name: pytest.approx(3e-4 + CLEARANCE) for name in "ab"}


@pytest.mark.parametrize("shape, by", [(Box((0.04, 0.04, 0.04)), 0.0), (BALL, 0.01)])
def test_what_an_axle_moves_up_and_down_as_it_turns_carries_nothing(shape, by):
    pair = [off_centre(caster(name, x, 3e-4, shape, mu=0.0), by)
            for name, x in (("a", 0.1), ("b", -0.1))]
    assert raised(tree_of(*pair, caster_type="continuous")) == {}


def swivelling(trail: float):
    """A fork before and one behind, whose wheels, 0.3 mm too low, run so far behind it (m)."""
    tyre = Collision("c", Cylinder(0.02, 0.01), Pose.from_xyz_rpy((0, 0, 0), (-math.pi / 2, 0, 0)),
                     Surface(mu=1.0, mu2=1.0))
    links, joints = [], []
    for name, x in (("front", 0.1), ("back", -0.1)):
        fork = f"{name} fork"
        links += [LinkDescription(fork, pose=Pose((x, 0, 0.05)), inertial=LIGHT),
                  LinkDescription(name, pose=Pose((x - trail, 0, 0.02 - 3e-4)), inertial=LIGHT,
                                  collisions=(tyre,))]
        joints += [JointDescription(fork, "continuous", "base", fork, axis=SWIVEL),
                   JointDescription(name, "continuous", fork, name, axis=AXLE)]
    return tree_of(*links, more=joints)


@pytest.mark.parametrize("trail", [0.01, 0.0025, -0.0025])
def test_wheels_behind_swivels_are_casters_and_get_smaller(trail):
    tree = swivelling(trail)
    after = {link.name: link for link in levelled(tree, LAYER).links}
    for name in ("front", "back"):
        (tyre,) = after[name].collisions
        assert tyre.geometry.radius == pytest.approx(0.02 - 3e-4 - CLEARANCE)
        assert tyre.pose.position == (0.0, 0.0, 0.0)
    assert after["left"].collisions == tree.links[1].collisions


@pytest.mark.parametrize("trail", [0.0, 0.0015, -0.0015])  # up to a tenth of the radius
def test_steered_wheels_stay_as_described(trail):
    tree = swivelling(trail)
    assert levelled(tree, LAYER) == tree


def plate(tmp_path, *feet: float):
    """A mesh: balls at these x (m) in one, whose origin is between the wheels."""
    balls = []
    for x in feet:
        balls.append(trimesh.creation.icosphere(subdivisions=1, radius=0.02))
        balls[-1].apply_translation((x, 0.0, 0.0))
    path = tmp_path / "plate.stl"
    trimesh.util.concatenate(balls).export(path)
    return Mesh(str(path))


@pytest.mark.parametrize("feet, up", [((0.1, -0.1), True), ((0.1,), False)])
def test_a_mesh_stands_on_its_lowest_corners(tmp_path, feet, up):
    tree = tree_of(caster("plate", 0.0, 3e-4, plate(tmp_path, *feet)))
    assert raised(tree) == ({"plate": pytest.approx(3e-4 + CLEARANCE, abs=1e-6)} if up else {})


def test_a_mesh_that_cannot_be_read_carries_nothing():
    pair = [caster("front", 0.1, 3e-4), caster("back", -0.1, 3e-4, Mesh("/none.stl"))]
    assert raised(tree_of(*pair)) == {}
    front = pair[0]
    lost = replace(front.collisions[0], name="lost", geometry=Mesh("/none.stl"))
    both = replace(front, collisions=(lost, *front.collisions))  # what it has besides does
    assert set(raised(tree_of(both, caster("back", -0.1, 3e-4)))) == {"front", "back"}


def test_a_box_from_front_to_back_comes_up():
    assert set(raised(tree_of(caster("plate", 0.0, 3e-4, Box((0.3, 0.05, 0.04)))))) == {"plate"}
    assert raised(tree_of(caster("plate", 0.1, 3e-4, Box((0.1, 0.05, 0.04))))) == {}


@pytest.mark.parametrize("x, radius, up", [
    (0.0, 0.15, True), (0.1, 0.15, True), (0.1, 0.09, False)])
def test_a_round_chassis_stands_on_its_rim(x, radius, up):
    """Level with the wheels it would carry the robot, and the wheels would slip in place."""
    assert raised(tree_of(caster("base_disc", x, 0.0, Cylinder(radius, 0.04)))) == (
        {"base_disc": pytest.approx(CLEARANCE)} if up else {})


@pytest.mark.parametrize("higher, up", [(5e-5, True), (2e-4, False)])
def test_a_box_whose_back_is_a_little_higher_stands_on_it_too(higher, up):
    plate = caster("plate", 0.0, 3e-4, Box((0.3, 0.05, 0.04)))
    tilted = replace(plate, pose=plate.pose * Pose.from_xyz_rpy((0, 0, 0), (0, higher / 0.3, 0)))
    assert bool(raised(tree_of(tilted))) == up


@pytest.mark.parametrize("kind", ["continuous", "ball"])
def test_slippery_meshes_that_roll_get_smaller(tmp_path, kind):
    pair = [caster(name, x, 3e-4, plate(tmp_path, 0.0), mu=0.0)
            for name, x in (("front", 0.1), ("back", -0.1))]
    after = levelled(tree_of(*pair, caster_type=kind), LAYER).links[3].collisions[0]
    part = 1.0 - (3e-4 + CLEARANCE) / 0.02
    assert after.geometry.scale == pytest.approx([part] * 3, rel=1e-3)


def test_a_wheel_has_a_tread_in_its_middle():
    wheel = tree_of().links[1]
    tread, shoulders = (collision.geometry for collision in engine_shapes(wheel))
    assert tread == Cylinder(0.05, TREAD)
    assert shoulders == Cylinder(0.05 - crown(wheel, find_tyre(wheel, wheel.collisions[0])), 0.03)


@pytest.mark.parametrize("tree", [
    tree_of(axis=SWIVEL), tree_of(axis=(1.0, 0.0, 0.0)), tree_of(axis=(0.0, 1.0, 0.1)),
    tree_of(wheel_type="fixed")])
def test_other_cylinders_are_left_alone(tree):
    for link in tree.links:
        assert list(engine_shapes(link)) == link.collisions


INERTIAL = ('<inertial><origin xyz="0 0 {}"/><mass value="{}"/><inertia ixx="0.02" iyy="0.02" '
            'izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>')
WHEEL = ('<link name="{0}">' + INERTIAL.format(0, 0.3) + '<collision><origin rpy="1.5708 0 0"/>'
         '<geometry><cylinder radius="0.05" length="0.03"/></geometry></collision></link>'
         '<joint name="{0}" type="continuous"><parent link="base"/><child link="{0}"/>'
         '<origin xyz="0 {1} 0.05"/><axis xyz="0 1 0"/></joint>')
FLAT = ('<robot name="flat"><link name="base">' + INERTIAL.format(0.05, 5) + '<collision>'
        '<origin xyz="0 0 0.05"/><geometry><box size="0.4 0.2 0.1"/></geometry></collision></link>'
        + WHEEL.format("left", 0.12) + WHEEL.format("right", -0.12) + "</robot>")


def test_a_flat_chassis_whose_bottom_is_level_with_the_wheels_drives():
    world = World(WorldDescription())
    plane = Collision("c", Plane((0.0, 0.0, 1.0), (9.0, 9.0)), surface=Surface(mu=1.0, mu2=1.0))
    world.spawn(ModelDescription("ground", static=True,
                                 links=(LinkDescription("l", collisions=(plane,)),)))
    robot = world.spawn(load_model(FLAT, Resources()))
    for side in ("left", "right"):
        robot.joint(side).drive_velocity(4.0, 5.0)
    world.step(2000)
    moved = robot.pose.position[0]
    world.close()
    assert moved == pytest.approx(4.0 * 0.05 * 2.0, rel=0.1)
