"""What touches, how hard and how it slides, against known answers."""

import math

import numpy as np
import pytest

from bullet_sim.description import Box, Collision, Cylinder, Plane, Sphere, Surface
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.physics.contact_parameters import contact_values
from bullet_sim.physics.contacts import signed_distance
from bullet_sim.pose import IDENTITY, Pose, conjugate, rotate
from bullet_sim.twist import Twist
from bullet_sim.world import World

GRAVITY = 9.8
MASS = 2.0
WEIGHT = MASS * GRAVITY


def box(size: str = "0.4 0.4 0.1", surface: str = "", name: str = "c", pose: str = "") -> str:
    return (f'<collision name="{name}"><pose>{pose or "0 0 0 0 0 0"}</pose><geometry><box>'
            f"<size>{size}</size></box></geometry><surface>{surface}</surface></collision>")


def ball(surface: str = "") -> str:
    return ('<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry>'
            f"<surface>{surface}</surface></collision>")


def link(shape: str, name: str = "l", pose: str = "0 0 0 0 0 0", more: str = "",
         inertia: float = 0.02) -> str:
    tensor = "".join(f"<{key}>{inertia}</{key}>" for key in ("ixx", "iyy", "izz"))
    return (f'<link name="{name}"><pose>{pose}</pose><inertial><mass>{MASS}</mass><inertia>{tensor}'
            f"</inertia></inertial>{shape}{more}</link>")


def read(body: str, name: str = "m"):
    text = f'<sdf version="1.6"><model name="{name}">{body}</model></sdf>'
    return load_model(text, Resources())


def ground(surface: str = "<friction><ode><mu>1</mu></ode></friction>"):
    return read("<static>true</static>" + link(box("20 20 1", surface, "top", "0 0 -0.5 0 0 0")),
                "ground")


def friction(mu: float, mu2: float | None = None, fdir1: str = "0 0 0") -> str:
    return (f"<friction><ode><mu>{mu}</mu><mu2>{mu if mu2 is None else mu2}</mu2>"
            f"<fdir1>{fdir1}</fdir1></ode></friction>")


def run(world: World, seconds: float) -> None:
    world.step(round(seconds / world.timestep))


def total(contacts) -> tuple[float, ...]:
    return tuple(map(sum, zip(*(contact.force for contact in contacts), strict=True)))


# --- contacts

def test_what_the_ground_bears_is_the_weight_also_at_rest(world):
    world.spawn(ground())
    world.spawn(read(link(box())), Pose((1.0, 2.0, 0.05)))
    run(world, 0.3)
    for seconds in (0.0, 3.0):
        run(world, seconds)
        contacts = world.contacts()
        assert {(c.collision1, c.collision2) for c in contacts} <= {
            ("m::l::c", "ground::l::top"), ("ground::l::top", "m::l::c")}
        up = 1.0 if contacts[0].collision1 == "m::l::c" else -1.0
        assert total(contacts) == pytest.approx((0.0, 0.0, up * WEIGHT), abs=0.02)
        for contact in contacts:
            assert contact.normal == pytest.approx((0.0, 0.0, up), abs=1e-3)
            assert 0.0 <= contact.depth < 1e-3
            assert contact.position[2] == pytest.approx(0.0, abs=1e-3)
            assert abs(contact.position[0] - 1.0) == pytest.approx(0.2, abs=0.01)
    assert world._client.auto_disable.disabled


def test_friction_is_part_of_the_force(world):
    slope = Pose.from_xyz_rpy((0, 0, 0), (0, 0.3, 0))
    world.spawn(ground(), slope)
    world.spawn(read(link(box())), slope * Pose((0, 0, 0.05)))
    run(world, 0.5)
    contacts = world.contacts()
    up = 1.0 if contacts[0].collision1 == "m::l::c" else -1.0
    assert total(contacts) == pytest.approx((0.0, 0.0, up * WEIGHT), abs=0.05)


def test_collisions_of_one_link_are_told_apart_by_where_it_touches(world):
    world.spawn(ground())
    feet = "".join(box("0.05 0.05 0.1", "", f"foot_{x}", f"{x} 0 0 0 0 0") for x in (-1, 1))
    model = world.spawn(read(link(feet + box("2 0.1 0.02", "", "plank", "0 0 0.06 0 0 0"))),
                        Pose.from_xyz_rpy((0, 0, 0.051), (0, 0, 0.4)))
    assert len(model.bodies[0].tree.links) == 1
    run(world, 0.5)
    touching = {contact.collision1 for contact in world.contacts()} | {
        contact.collision2 for contact in world.contacts()}
    assert touching == {"m::l::foot_-1", "m::l::foot_1", "ground::l::top"}


def test_what_does_not_touch_is_no_contact(world):
    world.spawn(ground())
    world.spawn(read(link(box())), Pose((0, 0, 0.06)))
    world.step()
    assert world.contacts() == []


# --- friction

@pytest.mark.parametrize("over, slides", [(0.93, False), (1.07, True)])
def test_mu_is_the_slope_at_which_a_box_slides(world, over, slides):
    # conforms: sdf surface/friction/ode/mu
    tilt = math.atan(0.5) * over
    slope = Pose.from_xyz_rpy((0, 0, 0), (0, tilt, 0))
    world.spawn(ground(), slope)
    model = world.spawn(read(link(box(surface=friction(0.5)))), slope * Pose((0, 0, 0.05)))
    run(world, 1.0)
    assert (math.dist(model.pose.position, model.initial_pose.position) > 0.02) == slides


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2])
@pytest.mark.parametrize("turned", [False, True])
def test_fdir1_parts_mu_from_mu2(world, yaw, turned):
    # conforms: sdf surface/friction/ode/mu2, sdf surface/friction/ode/fdir1
    world.spawn(ground())
    shape = box(surface=friction(0.8, 0.2, "1 0 0"),
                pose="0 0 0 0 0 1.5707963" if turned else "")
    for direction, mu in (((1, 0, 0), 0.8), ((0, 1, 0), 0.2)):
        if turned:
            direction = (-direction[1], direction[0], 0)
        model = world.spawn(read(link(shape)), Pose.from_xyz_rpy((0, 0, 0.05), (0, 0, yaw)))
        run(world, 0.2)
        along = rotate(model.pose.orientation, direction)
        model.set_twist(Twist(tuple(4.0 * part for part in along)))
        run(world, 0.3)
        slowed = 4.0 - sum(a * v for a, v in zip(along, model.twist.linear, strict=True))
        assert slowed == pytest.approx(mu * GRAVITY * 0.3, rel=0.06)
        world.delete("m")


@pytest.mark.parametrize("mu, mu2, alike", [(0.5, 0.5, True), (0.0, 0.0, True), (0.5, 0.2, False)])
def test_only_two_coefficients_that_differ_have_a_direction(mu, mu2, alike):
    surface = Surface(mu, mu2, (1.0, 0.0, 0.0))
    values = contact_values(Collision("c", Box((1.0, 1.0, 1.0)), surface=surface), False, IDENTITY,
                            MASS)
    assert ("anisotropicFriction" not in values) == alike
    assert values["lateralFriction"] == mu


@pytest.mark.parametrize("shape, point, distance", [
    (Box((2.0, 4.0, 6.0)), (0.5, 0.0, 0.0), -0.5), (Box((2.0, 4.0, 6.0)), (4.0, 6.0, 0.0), 5.0),
    (Box((2.0, 4.0, 6.0)), (0.0, 0.0, -5.0), 2.0), (Sphere(0.5), (0.0, 3.0, 4.0), 4.5),
    (Cylinder(1.0, 2.0), (0.0, 0.75, 0.5), -0.25), (Cylinder(1.0, 2.0), (4.0, 0.0, -5.0), 5.0),
    (Plane((0.0, 0.0, 2.0), (1.0, 1.0)), (9.0, 9.0, 0.3), 0.3)])
def test_a_point_s_distance_from_a_shape(shape, point, distance):
    assert signed_distance(shape, point) == pytest.approx(distance)


# --- hardness and bounce

@pytest.mark.parametrize("kp, kd", [(2000.0, 50.0), (2e4, 10.0)])
def test_a_soft_contact_gives_way_by_its_stiffness(world, kp, kd):
    # conforms: sdf surface/contact/ode/kp, sdf surface/contact/ode/kd
    world.spawn(ground())
    soft = f"<contact><ode><kp>{kp}</kp><kd>{kd}</kd></ode></contact>"
    model = world.spawn(read(link(ball(soft))), Pose((0, 0, 0.1)))
    run(world, 2.0)
    assert 0.1 - model.pose.position[2] == pytest.approx(WEIGHT / kp, rel=0.05)


@pytest.mark.parametrize("threshold, told, bounce", [
    ("<threshold>0</threshold>", 0.5, 0.5), ("<threshold>0</threshold>", 1.0, 1.0),
    ("", 0.5, 0.0)])
def test_a_ball_bounces_if_the_threshold_allows_it(world, threshold, told, bounce):
    # conforms: sdf surface/bounce/restitution_coefficient, sdf surface/bounce/threshold
    elastic = (f"<bounce><restitution_coefficient>{told}</restitution_coefficient>{threshold}"
               "</bounce>")
    world.spawn(ground(elastic))
    model = world.spawn(read(link(ball(elastic))), Pose((0, 0, 1.1)))
    run(world, math.sqrt(2.0 / GRAVITY) + 0.01)
    speed = math.sqrt(2 * GRAVITY)
    rebound = model.twist.linear[2] + GRAVITY * 0.01
    assert rebound == pytest.approx(bounce * speed, abs=(0.03 if bounce else 0.2) * speed)


# --- who meets whom

def mask(bits: str) -> str:
    return f"<contact><collide_bitmask>{bits}</collide_bitmask></contact>"


@pytest.mark.parametrize("lower, upper, meet", [
    ("1", "2", False), ("3", "2", True), ("65535", "4", True), ("0", "65535", False)])
def test_bit_masks_say_who_collides(world, lower, upper, meet):
    # conforms: sdf surface/contact/collide_bitmask
    world.spawn(ground(mask(lower)))
    model = world.spawn(read(link(box(surface=mask(upper)))), Pose((0, 0, 0.05)))
    run(world, 0.5)
    assert (model.pose.position[2] > 0) == meet


def test_rays_meet_what_collides_with_some_only(world):
    world.spawn(ground(mask("2")))
    hit = world.cast_rays(np.array([[0.0, 0.0, 1.0]]), np.array([[0.0, 0.0, -1.0]]))
    assert hit.fraction == pytest.approx([0.5])


def test_collide_without_contact_lets_things_pass(world):
    # conforms: sdf surface/contact/collide_without_contact
    world.spawn(ground("<contact><collide_without_contact>true</collide_without_contact></contact>"))
    model = world.spawn(read(link(box())), Pose((0, 0, 0.05)))
    run(world, 0.5)
    assert model.pose.position[2] < -1.0


def test_a_moving_mesh_collides_as_its_hull_and_a_static_one_as_it_is(world, tmp_path):
    # conforms: collision of a moving mesh
    corners = [(x, y, z) for x in (-1, -0.8, 0.8, 1) for y in (-1, 1) for z in (0, 1)]
    faces = []
    for first in (1, 9):  # two walls with a gap between them
        a, b, c, d, e, f, g, h = range(first, first + 8)
        faces += [(a, b, d, c), (e, g, h, f), (a, e, f, b), (c, d, h, g), (a, c, g, e),
                  (b, f, h, d)]
    path = tmp_path / "walls.obj"
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners)
                    + "".join("f " + " ".join(map(str, face)) + "\n" for face in faces))
    mesh = f'<collision name="c"><geometry><mesh><uri>{path}</uri></mesh></geometry></collision>'
    held = '<joint name="w" type="fixed"><parent>world</parent><child>l</child></joint>'
    for more, x in ((held, 0.0), ("<static>true</static>", 5.0)):
        world.spawn(read(more + link(mesh)), Pose((x, 0, 0)), f"walls at {x}")
    balls = [world.spawn(read(link(ball())), Pose((x, 0, 1.2)), f"at {x}") for x in (0.0, 5.0)]
    run(world, 0.5)
    heights = [each.pose.position[2] for each in balls]
    assert heights[0] == pytest.approx(1.1, abs=0.01)
    assert heights[1] < 0.5


def stack(model: str = "", each: str = "", joint: str = "") -> str:
    held = '<joint name="w" type="fixed"><parent>world</parent><child>a</child></joint>'
    return (model + link(box(), "a", more=each) + link(box(), "b", "0 0 0.3 0 0 0", each)
            + held + joint)


SELF = "<self_collide>true</self_collide>"


@pytest.mark.parametrize("model, each, meet", [
    ("", "", False), (SELF, "", True), ("", SELF, True)])
def test_links_of_one_model_meet_only_if_both_say_so(world, model, each, meet):
    # conforms: sdf model/self_collide, sdf link/self_collide
    made = world.spawn(read(stack(model, each)))
    run(world, 0.6)
    assert (made.links["b"].pose.position[2] > 0.0) == meet


@pytest.mark.parametrize("each, meet", [("", False), (SELF, True)])
def test_the_same_within_one_tree_but_never_next_to_a_joint(world, each, meet):
    """a carries b, b carries c; b and c overlap a from the start, c comes down on a."""
    slider = "<axis><xyz>0 0 1</xyz></axis>"
    made = world.spawn(read(
        link(box(), "a", more=each) + link(box(), "b", "0 0 0.05 0 0 0", each)
        + link(box(), "c", "0 0 0.4 0 0 0", each)
        + '<joint name="w" type="fixed"><parent>world</parent><child>a</child></joint>'
        + f'<joint name="i" type="prismatic"><parent>a</parent><child>b</child>{slider}</joint>'
        + f'<joint name="j" type="prismatic"><parent>b</parent><child>c</child>{slider}</joint>'))
    run(world, 1.0)
    assert made.links["b"].pose.position[2] < -1.0
    assert (made.links["c"].pose.position[2] > 0.0) == meet


def test_what_was_filtered_is_forgotten_with_the_model(world):
    world.spawn(ground())
    world.spawn(read(stack()), Pose((0, 0, 0.5)))
    world.delete("m")
    for name, height in (("one", 0.05), ("two", 0.15)):
        world.spawn(read(link(box())), Pose((0, 0, height)), name)
    run(world, 0.5)
    assert world.models["two"].pose.position[2] == pytest.approx(0.15, abs=2e-3)


# --- links that obey other laws

def test_a_kinematic_link_moves_as_it_is_told_and_carries_others(world):
    # conforms: sdf link/kinematic
    lift = world.spawn(read(link(box("1 1 0.1"), more="<kinematic>true</kinematic>"), "lift"),
                       Pose((0, 0, 1.0)))
    load = world.spawn(read(link(box())), Pose((0, 0, 1.1)))
    run(world, 0.5)
    assert lift.pose.position == pytest.approx((0, 0, 1.0), abs=1e-9)
    lift.set_twist(Twist((0.2, 0.0, 0.1)))
    run(world, 2.0)
    assert lift.pose.position == pytest.approx((0.4, 0.0, 1.2), abs=1e-3)
    assert load.pose.position == pytest.approx((0.4, 0.0, 1.3), abs=0.01)


def test_without_gravity_a_link_floats_and_the_world_comes_to_rest(world):
    # conforms: sdf link/gravity
    model = world.spawn(read(link(box(), more="<gravity>false</gravity>")), Pose((0, 0, 1.0)))
    run(world, 2.0)
    assert model.pose.position == pytest.approx((0, 0, 1.0), abs=1e-9)
    assert world._client.auto_disable.disabled
    model.links["l"].apply_force((0.0, 0.0, MASS / world.timestep))
    run(world, 0.5)
    assert model.pose.position[2] == pytest.approx(1.5, abs=1e-3)


def test_velocity_decay_slows_down(world):
    # conforms: sdf link/velocity_decay
    decay = "<gravity>false</gravity><velocity_decay><linear>0.002</linear>" \
            "<angular>0.001</angular></velocity_decay>"
    model = world.spawn(read(link(box(), more=decay)))
    model.set_twist(Twist((2.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    run(world, 0.5)  # of its speed a body loses that part in every step
    assert model.twist.linear[0] == pytest.approx(2.0 * (1 - 0.002) ** 500, rel=1e-3)
    assert model.twist.angular[2] == pytest.approx((1 - 0.001) ** 500, rel=1e-3)


def test_links_of_one_body_each_have_a_decay_of_their_own(world):
    decay = "<velocity_decay><linear>0.002</linear></velocity_decay>"
    slider = "<axis><xyz>1 0 0</xyz></axis>"
    model = world.spawn(read(
        link("", "base") + link("", "slow", more=decay) + link("", "free")
        + '<joint name="w" type="fixed"><parent>world</parent><child>base</child></joint>'
        + "".join(f'<joint name="{name}" type="prismatic"><parent>base</parent><child>{name}'
                  f"</child>{slider}</joint>" for name in ("slow", "free"))))
    for name in ("slow", "free"):
        model.joint(name).reset(0.0, 1.0)
    run(world, 0.5)
    assert model.joint("slow").velocity == pytest.approx((1 - 0.002) ** 500, rel=1e-3)
    assert model.joint("free").velocity == pytest.approx(1.0, rel=1e-6)


def test_a_static_model_stays(world):
    # conforms: sdf model/static
    model = world.spawn(read("<static>true</static>" + link(box())), Pose((0, 0, 3.0)))
    run(world, 0.5)
    assert model.pose.position == (0, 0, 3.0)
    assert rotate(conjugate(model.pose.orientation), (1, 0, 0)) == (1, 0, 0)


# --- what no law covers

def test_a_motion_that_is_no_number_starts_the_model_again(world, caplog):
    import pybullet
    world.spawn(ground())
    broken = world.spawn(read(link(box())), Pose((0, 0, 0.05)))
    other = world.spawn(read(link(box())), Pose((2, 0, 0.05)), "other")
    run(world, 0.2)
    for _ in range(2):
        broken.bodies[0].engine.change(pybullet.applyExternalForce, -1, (math.nan, 0, 0), (0, 0, 0),
                               pybullet.WORLD_FRAME)
        run(world, 1.0)
    assert broken.pose.position == pytest.approx((0, 0, 0.05), abs=1e-3)
    assert other.pose.position == pytest.approx((2, 0, 0.05), abs=1e-3)
    (record,) = caplog.records
    assert record.getMessage().startswith("model m: its pose or velocity is not finite; it is")


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_what_is_no_number_does_not_reach_the_engine(world, caplog, number):
    model = world.spawn(read(link(box())), Pose((0, 0, 0.05)))
    for _ in range(3):
        model.links["l"].apply_force((number, 0.0, 0.0))
    model.set_pose(Pose((number, 0.0, 0.0)))
    model.set_twist(Twist((number, 0.0, 0.0)))
    world.step()
    assert model.pose.position == pytest.approx((0, 0, 0.05), abs=1e-3)
    assert [record.getMessage().split(" of ")[0] for record in caplog.records] == [
        "l: a force", "l: a pose", "l: a velocity"]


@pytest.mark.parametrize("mass", ["0", "1e-12", "1e9", "1e12"])
@pytest.mark.parametrize("inertia", ["0", "1e-20", "1e12"])
def test_masses_and_inertias_of_all_sizes_stand(world, mass, inertia):
    # conforms: sdf inertial/mass, sdf inertial/inertia
    world.spawn(ground())
    text = link(box()).replace(f"<mass>{MASS}", f"<mass>{mass}").replace(">0.02<", f">{inertia}<")
    model = world.spawn(read(text), Pose((0, 0, 0.06)))
    run(world, 1.0)
    assert model.pose.position[2] == pytest.approx(0.05, abs=0.01)


def test_moments_that_no_body_has_let_it_turn_all_the_same(world):
    text = link(box(), more="<gravity>false</gravity>").replace("<ixx>0.02", "<ixx>1")
    model = world.spawn(read(text))
    model.links["l"].apply_force((0, 0, 0), (0, 0, 1.0))
    world.step()
    rate = model.twist.angular[2]
    assert rate == pytest.approx(world.timestep / 0.5, rel=1e-3)
