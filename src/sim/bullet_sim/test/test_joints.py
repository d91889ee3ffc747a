"""Joints of every type against known answers."""

import math
from dataclasses import replace

import pytest

from bullet_sim.description import WorldDescription
from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.joint import LoopJoint
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Pose
from bullet_sim.twist import Twist
from bullet_sim.world import World

GRAVITY = 9.8
NO_WAY = "<limit><lower>0</lower><upper>0</upper></limit>"


def link(name: str, pose: str = "0 0 0 0 0 0", mass: float = 1.0, com: str = "0 0 0 0 0 0",
         inertia: float = 1e-2, more: str = "") -> str:
    tensor = "".join(f"<{key}>{inertia}</{key}>" for key in ("ixx", "iyy", "izz"))
    return (f'<link name="{name}"><pose>{pose}</pose><inertial><pose>{com}</pose>'
            f"<mass>{mass}</mass><inertia>{tensor}</inertia></inertial>{more}</link>")


def joint(name: str, kind: str, parent: str, child: str, more: str = "") -> str:
    return (f'<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child>'
            f"{more}</joint>")


def axis(xyz: str, more: str = "", tag: str = "axis") -> str:
    return f"<{tag}><xyz>{xyz}</xyz>{more}</{tag}>"


def read(body: str, version: str = "1.6"):
    text = f'<sdf version="{version}"><model name="m">{body}</model></sdf>'
    return load_model(text, Resources())


def run(world: World, seconds: float) -> None:
    world.step(round(seconds / world.timestep))


# --- one axis

def test_a_pendulum_swings_with_its_period(world):
    # conforms: sdf joint/axis/xyz, sdf joint@type/revolute, sdf joint/axis
    # conforms: sdf joint/parent, sdf joint/child
    model = world.spawn(read(link("arm", com="0 0 -1 0 0 0", inertia=1e-6)
                             + joint("j", "revolute", "world", "arm", axis("0 1 0"))))
    hinge = model.joint("j")
    hinge.reset(0.05)
    period = 2 * math.pi * math.sqrt(1.0 / GRAVITY)
    run(world, period / 4)
    assert hinge.position == pytest.approx(0.0, abs=5e-4)
    run(world, period / 4)
    assert hinge.position == pytest.approx(-0.05, abs=2e-4)


@pytest.mark.parametrize("stiffness", [100, 200_000])  # the second in 28 steps
def test_a_spring_swings_about_its_reference(world, stiffness):
    # conforms: sdf joint/axis/dynamics/spring_reference, sdf joint/axis/dynamics/spring_stiffness
    # conforms: sdf joint@type/prismatic
    spring = "<dynamics><spring_reference>0.1</spring_reference>" \
             f"<spring_stiffness>{stiffness}</spring_stiffness></dynamics>"
    slider = world.spawn(read(link("cart", mass=4.0) + joint(
        "j", "prismatic", "world", "cart", axis("1 0 0", spring)))).joint("j")
    for place in (0.2, 0.0):
        run(world, math.pi * math.sqrt(4.0 / stiffness))
        assert slider.position == pytest.approx(place, abs=1e-3)


def test_damping_slows_down_exponentially(world):
    # conforms: sdf joint/axis/dynamics/damping
    model = world.spawn(read(link("cart", mass=2.0) + joint(
        "j", "prismatic", "world", "cart",
        axis("1 0 0", "<dynamics><damping>4</damping></dynamics>"))))
    model.joint("j").reset(0.0, 1.0)
    run(world, 0.5)
    assert model.joint("j").velocity == pytest.approx(math.exp(-4 / 2 * 0.5), rel=5e-3)


@pytest.mark.parametrize("more", ["", link("bob") + joint("b", "ball", "wheel", "bob")])
@pytest.mark.parametrize("damping, stiffness", [(0.7, 0.0), (1e3, 0.0), (0.01, 1e6)])
def test_what_is_too_stiff_for_a_step_comes_to_rest(world, damping, stiffness, more):
    # conforms: sdf joint@type/continuous
    dynamics = f"<dynamics><damping>{damping}</damping>" \
               f"<spring_stiffness>{stiffness}</spring_stiffness></dynamics>"
    wheel = world.spawn(read(link("wheel", mass=0.01, inertia=1e-5) + more + joint(
        "j", "continuous", "world", "wheel", axis("0 0 1", dynamics)))).joint("j")
    wheel.reset(0.0, 10.0)
    run(world, 0.2)
    assert abs(wheel.velocity) < 0.01


def test_dry_friction_holds_and_brakes(world):
    # conforms: sdf joint/axis/dynamics/friction
    model = world.spawn(read(link("cart", mass=2.0) + joint(
        "j", "prismatic", "world", "cart",
        axis("1 0 0", "<dynamics><friction>3</friction></dynamics>"))))
    slider = model.joint("j")
    slider.reset(0.0, 1.0)
    run(world, 0.4)
    assert slider.velocity == pytest.approx(1.0 - 3 / 2 * 0.4, abs=1e-3)
    run(world, 0.6)
    assert slider.velocity == pytest.approx(0.0, abs=1e-6)


def test_stops_hold(world):
    # conforms: sdf joint/axis/limit/lower, sdf joint/axis/limit/upper
    limits = "<limit><lower>-0.5</lower><upper>0.25</upper></limit>"
    model = world.spawn(read(link("arm", com="1 0 0 0 0 0") + joint(
        "j", "revolute", "world", "arm", axis("0 1 0", limits))))
    run(world, 2.0)
    assert model.joint("j").position == pytest.approx(0.25, abs=2e-3)
    for _ in range(1000):
        model.joint("j").drive_effort(-50.0)
        world.step()
    assert model.joint("j").position == pytest.approx(-0.5, abs=2e-3)


def test_an_effort_is_cut_to_the_limit(world):
    # conforms: sdf joint/axis/limit/effort
    model = world.spawn(read(link("cart", mass=2.0) + joint(
        "j", "prismatic", "world", "cart", axis("1 0 0", "<limit><effort>4</effort></limit>"))))
    for _ in range(500):
        model.joint("j").drive_effort(100.0)
        world.step()
    assert model.joint("j").velocity == pytest.approx(4 / 2 * 0.5, rel=1e-3)


def test_an_effort_drives_no_faster_than_the_limit(world):
    # conforms: sdf joint/axis/limit/velocity
    model = world.spawn(read(link("cart", mass=2.0) + joint(
        "j", "prismatic", "world", "cart",
        axis("1 0 0", "<limit><velocity>0.5</velocity></limit>"))))
    for _ in range(1000):
        model.joint("j").drive_effort(4.0)
        world.step()
    assert model.joint("j").velocity == pytest.approx(0.5, abs=3e-3)


def test_a_motor_of_negative_effort_is_none(world):
    model = world.spawn(read(link("arm") + joint("j", "revolute", "world", "arm", axis("0 0 1"))))
    model.joint("j").drive_velocity(3.0, -5.0)
    run(world, 0.5)
    assert model.joint("j").velocity == 0.0


def test_a_joint_of_a_static_model_says_why_it_does_not_move(world):
    model = world.spawn(read("<static>true</static>" + link("base") + link("arm")
                             + joint("j", "revolute", "base", "arm", axis("0 0 1"))))
    with pytest.raises(SimulationError, match="joint 'j' does not move, as model m is static"):
        model.joint("j")


def test_a_fixed_joint_by_two_stops_does_not_give_way(world):
    model = world.spawn(read(link("a", mass=100.0) + link("b", "1 0 0 0 0 0", 50.0) + joint(
        "w", "fixed", "world", "a") + joint(
        "j", "revolute", "a", "b", axis("0 1 0", NO_WAY))))
    run(world, 0.5)
    assert model.links["b"].pose.position == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)
    assert (model.joint("j").position, model.joint("w").position) == (0.0, 0.0)
    assert list(model.joints) == ["j"]


@pytest.mark.parametrize("version, more, turned", [
    ("1.6", "", True), ("1.4", "", False),
    ("1.6", "<use_parent_model_frame>true</use_parent_model_frame>", False)])
def test_the_frame_an_axis_is_given_in(version, more, turned):
    # conforms: sdf joint/axis/use_parent_model_frame
    model = read(link("arm", "0 0 0 0 0 1.5707963") + joint(
        "j", "revolute", "world", "arm", axis("1 0 0", more)), version)
    expected = (1.0, 0.0, 0.0) if turned else (0.0, -1.0, 0.0)  # in the link's, a quarter round
    assert model.joints[0].axis == pytest.approx(expected, abs=1e-6)


def test_an_axis_expressed_in_another_frame():
    # conforms: sdf joint/axis/xyz@expressed_in
    model = read(link("post") + link("arm", "0 0 0 0 0 1.5707963") + joint(
        "j", "revolute", "post", "arm",
        '<axis><xyz expressed_in="post">1 0 0</xyz></axis>'), "1.7")
    assert model.joints[0].axis == pytest.approx((0.0, -1.0, 0.0), abs=1e-6)


# --- more axes

def test_a_ball_joint_swings_round_as_a_conical_pendulum(world):
    # conforms: sdf joint@type/ball
    model = world.spawn(read(link("bob", com="0 0 -1 0 0 0", inertia=1e-6)
                             + joint("j", "ball", "world", "bob")))
    tilt, body = 0.5, model.bodies[0]
    assert body.speeds() == (0.0, 0.0)
    rate = math.sqrt(GRAVITY / math.cos(tilt))
    turn = Pose.from_xyz_rpy((0, 0, 0), (0.0, tilt, 0.0))
    local = turn.inverse().transform((0.0, 0.0, rate))
    body.joints.reset_ball("j", turn.orientation, local)
    run(world, math.pi / rate)
    bob = model.links["bob"].pose.transform((0.0, 0.0, -1.0))
    assert bob == pytest.approx((math.sin(tilt), 0.0, -math.cos(tilt)), abs=2e-3)
    assert (model.joint("j").position, list(model.joints)) == (0.0, ["j"])
    world.reset_models()
    assert model.links["bob"].pose.rpy() == pytest.approx((0, 0, 0), abs=1e-9)


@pytest.mark.parametrize("kind", ["universal", "revolute2"])
@pytest.mark.parametrize("ends", [("world", "arm"), ("arm", "world")])
def test_two_axes_turn_one_after_the_other(world, kind, ends):
    # conforms: sdf joint@type/universal, sdf joint@type/revolute2, sdf joint/axis2/xyz
    # conforms: sdf joint/axis2
    model = world.spawn(read(link("arm") + joint(
        "j", kind, *ends, axis("0 0 1") + axis("1 0 0", tag="axis2"))))
    first = model.joint("j")
    first.reset(0.3)
    first.second_axis.reset(0.2)
    about = Pose.from_xyz_rpy((0, 0, 0), (0, 0, 0.3)) * Pose.from_xyz_rpy((0, 0, 0), (0.2, 0, 0))
    expected = about if ends[1] == "arm" else about.inverse()
    assert model.links["arm"].pose.rpy() == pytest.approx(expected.rpy(), abs=1e-6)
    assert list(model.joints) == ["j"]


def test_each_of_two_axes_has_its_own_stops_and_damping(world):
    # conforms: sdf joint/axis2/limit, sdf joint/axis2/dynamics
    second = "<limit><lower>-0.1</lower><upper>0.1</upper></limit>" \
             "<dynamics><damping>0.5</damping></dynamics>"
    model = world.spawn(read(link("arm") + joint(
        "j", "universal", "world", "arm", axis("0 0 1") + axis("1 0 0", second, "axis2"))))
    wheel = model.joint("j")
    for _ in range(1000):
        wheel.second_axis.drive_effort(0.2)
        world.step()
    assert wheel.second_axis.position == pytest.approx(0.1, abs=2e-3)
    assert wheel.position == pytest.approx(0.0, abs=1e-3)
    assert wheel.second_axis.description.damping == 0.5


def test_a_screw_travels_with_its_turn(world):
    # conforms: sdf joint@type/screw, sdf joint/thread_pitch
    pitch = -100.0  # rad/m: a right-handed thread of 1 cm a radian
    model = world.spawn(read(link("nut", inertia=0.01) + joint(
        "j", "screw", "world", "nut", axis("0 0 1") + f"<thread_pitch>{pitch}</thread_pitch>")))
    run(world, 0.5)
    turn, height = model.joint("j").position, model.links["nut"].pose.position[2]
    assert height == pytest.approx(turn / 100.0, rel=1e-4)
    # Falling turns it: m g = (m + I / p^2) a with p the travel of a radian.
    acceleration = GRAVITY / (1.0 + 0.01 / 0.01 ** 2)
    assert height == pytest.approx(-acceleration * 0.5 ** 2 / 2, rel=5e-3)
    model.joint("j").reset(math.pi)
    assert model.links["nut"].pose.position[2] == pytest.approx(0.01 * math.pi)
    assert list(model.joints) == ["j"]


def gearbox(more: str, roll: float = 0.0) -> str:
    return (link("frame") + link("sun") + link("wheel", f"1 0 0 {roll} 0 0")
            + joint("w", "fixed", "world", "frame")
            + joint("a", "continuous", "frame", "sun", axis("0 0 1"))
            + joint("b", "continuous", "frame", "wheel", axis("0 0 -1"))
            + joint("g", "gearbox", "sun", "wheel", axis("0 0 1") + axis("0 0 1", tag="axis2")
                    + more))


@pytest.mark.parametrize("roll, way", [(0.0, 1), (math.pi, -1)])
def test_a_gearbox_couples_two_joints_by_its_ratio(world, roll, way):
    # conforms: sdf joint@type/gearbox, sdf joint/gearbox_ratio, sdf joint/gearbox_reference_body
    model = world.spawn(read(gearbox("<gearbox_ratio>3</gearbox_ratio>"
                                     "<gearbox_reference_body>frame</gearbox_reference_body>",
                                     roll)))
    for _ in range(500):
        model.joint("a").drive_effort(0.01)
        world.step()
    # theta_1 = -ratio theta_2 about z; joint b counts the other way round, unless its wheel does.
    assert model.joint("a").position > 0.1
    assert model.joint("b").position == pytest.approx(way * model.joint("a").position / 3, rel=1e-3)
    # The sun feels the wheel's inertia by the ratio squared.
    assert model.joint("a").velocity == pytest.approx(0.01 * 0.5 / (1e-2 * (1 + 1 / 9)), rel=1e-2)


def test_a_gearbox_without_a_body_to_refer_to_is_one_warning(world, caplog):
    world.spawn(read(gearbox("")))
    (record,) = caplog.records
    assert "gearbox g has no effect" in record.getMessage()


# --- loops

def four_bar(last: str = "revolute", third: str = "revolute") -> str:
    """Two cranks of 0.5 m, 1 m apart, and a coupler between their upper ends."""
    return (link("left", com="0 0 0.25 0 0 0") + link("right", "1 0 0 0 0 0", com="0 0 0.25 0 0 0")
            + link("bar", "0 0 0.5 0 0 0", com="0.5 0 0 0 0 0")
            + joint("a", "revolute", "world", "left", axis("0 1 0"))
            + joint("b", "revolute", "left", "bar", axis("0 1 0"))
            + joint("c", third, "world", "right", axis("0 1 0"))
            + joint("d", last, "right", "bar", "<pose>1 0 0 0 0 0</pose>" + axis("0 1 0")))


@pytest.mark.parametrize("last", ["revolute", "ball", "universal"])
def test_a_four_bar_loop_stays_closed(world, caplog, last):
    # conforms: sdf joint (closing a loop)
    model = world.spawn(read(four_bar(last)), Pose.from_xyz_rpy((2, 1, 3), (0, 0, 0.7)))
    crank = model.joint("a")
    for _ in range(3000):
        crank.drive_velocity(1.0, 1000.0)
        world.step()
    assert crank.position == pytest.approx(3.0, abs=0.01)
    assert model.joint("c").position == pytest.approx(crank.position, abs=2e-3)
    assert model.joint("b").position == pytest.approx(-crank.position, abs=2e-3)
    ends = (model.links["bar"].pose.transform((1, 0, 0)),
            model.links["right"].pose.transform((0, 0, 0.5)))
    assert math.dist(*ends) < 2e-3
    assert not caplog.records


def test_the_joint_that_closes_a_loop_can_be_read_and_driven(world):
    model = world.spawn(read(four_bar()))
    closing = next(joint for joint in model.joints.values() if isinstance(joint, LoopJoint))
    assert set(model.joints) == set("abcd")
    for _ in range(300):
        model.joint("a").drive_velocity(1.0, 1000.0)
        world.step()
    sign = {"c": 1.0, "d": -1.0, "b": -1.0}[closing.name]
    assert closing.position == pytest.approx(sign * 0.3, abs=5e-3)
    assert closing.velocity == pytest.approx(sign * 1.0, abs=1e-2)


def test_a_ball_that_closes_a_loop_is_reset_with_the_others(world):
    model = world.spawn(read(four_bar(third="ball")))
    closing = model.joint("c")
    assert (closing.description.type, closing.position) == ("ball", 0.0)
    for _ in range(300):
        model.joint("a").drive_velocity(1.0, 1000.0)
        world.step()
    assert (closing.position, closing.velocity) == (0.0, 0.0)  # as of a ball in a tree
    assert closing.reaction() == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.reset_models()
    assert model.joint("a").position == pytest.approx(0.0, abs=1e-6)
    assert model.links["bar"].pose.position == pytest.approx((0, 0, 0.5), abs=1e-6)


@pytest.mark.parametrize("third, moved", [("ball", False), ("revolute", True)])
def test_an_effort_on_a_ball_that_closes_a_loop_does_nothing(world, third, moved):
    model = world.spawn(read(four_bar(third=third)))
    closing = model.joint("c" if third == "ball" else "d")
    world.step(10)
    before = model.joint("a").position
    for _ in range(100):
        closing.drive_effort(5.0)
        (group,) = model.joint_groups([closing.name])
        group.drive_efforts([5.0])
        world.step()
    assert (abs(model.joint("a").position - before) > 1e-2) == moved


@pytest.mark.parametrize("kind", ["fixed", "prismatic"])
def test_a_loop_closed_by_a_fixed_or_sliding_joint(world, kind):
    beside = joint("k", kind, "b", "c", axis("0 0 1"))
    model = world.spawn(read(
        link("a") + link("b", "0 0 1 0 0 0") + link("c", "0.5 0 1 0 0 0")
        + joint("w", "fixed", "world", "a")
        + joint("i", "prismatic", "a", "b", axis("0 0 1", "<limit><lower>-0.2</lower>"
                                                "<upper>0</upper></limit>"))
        + joint("j", "prismatic", "a", "c", axis("0 0 1")) + beside))
    run(world, 1.0)
    heights = [model.links[name].pose.position[2] for name in "bc"]
    assert heights[0] == pytest.approx(0.8, abs=2e-3)
    expected = 0.8 if kind == "fixed" else 1.0 - GRAVITY / 2
    assert heights[1] == pytest.approx(expected, abs=0.02)


def test_loops_and_springs_outlive_a_change_of_masses(world):
    model = world.spawn(read(four_bar()))
    bar = model.links["bar"]
    model.change_link(bar, bar.description.inertial, gravity=False)
    for _ in range(1000):
        model.joint("a").drive_velocity(1.0, 1000.0)
        world.step()
    ends = (bar.pose.transform((1, 0, 0)), model.links["right"].pose.transform((0, 0, 0.5)))
    assert math.dist(*ends) < 2e-3
    world.delete("m")
    assert world.models == {}


# --- what a joint bears

FEEDBACK = "<physics><provide_feedback>true</provide_feedback></physics>"


@pytest.mark.parametrize("kind", ["fixed", "revolute"])
@pytest.mark.parametrize("ends", [("post", "arm"), ("arm", "post")])
def test_a_joint_bears_the_weight_of_what_hangs_on_it(world, kind, ends):
    # conforms: sdf joint/physics/provide_feedback
    # conforms: sdf joint/pose, sdf joint@type/fixed
    # The arm is turned by a quarter about z and has its 2 kg 0.3 m along its own x: the world's y.
    limits = axis("1 0 0", NO_WAY)
    place = "<pose>0 0.1 0 0 0 0</pose>"
    model = world.spawn(read(
        link("post", "0 0 1 0 0 0") + link("arm", "0 0 1 0 0 1.5707963", 2.0, "0.3 0 0 0.4 0.5 0.6")
        + joint("w", "fixed", "world", "post")
        + joint("j", kind, *ends, place + limits + FEEDBACK)))
    run(world, 0.2)
    force, torque = model.joint("j").reaction()
    weight = 2.0 * GRAVITY
    if ends[1] == "arm":  # what hangs pulls down; its arm about the anchor is (0.3, -0.1) in arm
        assert force == pytest.approx((0.0, 0.0, -weight), abs=1e-3)
        assert torque == pytest.approx((0.1 * weight, 0.3 * weight, 0.0), abs=1e-3)
    else:  # the post is the child: it bears the arm, in its own axes, about (0, 0.1)
        assert force == pytest.approx((0.0, 0.0, weight), abs=1e-3)
        assert torque == pytest.approx((0.2 * weight, 0.0, 0.0), abs=1e-3)


def test_a_motors_effort_is_part_of_what_the_joint_bears(world):
    model = world.spawn(read(link("arm", mass=2.0, com="0.3 0 0 0 0 0") + joint(
        "j", "revolute", "world", "arm", axis("0 1 0") + FEEDBACK)))
    model.joint("j").drive_velocity(0.0, 100.0)
    run(world, 0.2)
    force, torque = model.joint("j").reaction()
    assert force == pytest.approx((0.0, 0.0, -2.0 * GRAVITY), abs=1e-3)
    assert torque == pytest.approx((0.0, 0.3 * 2.0 * GRAVITY, 0.0), abs=1e-3)


def test_a_fixed_joint_to_the_world_bears_too_and_is_read_at_rest(world):
    model = world.spawn(read(link("lamp", "0 0 2 0 0 0", 3.0)
                             + joint("j", "fixed", "world", "lamp", FEEDBACK)))
    run(world, 3.0)
    force, _ = model.joint("j").reaction()
    assert force == pytest.approx((0.0, 0.0, -3.0 * GRAVITY), abs=1e-3)


@pytest.mark.parametrize("rests", [False, True])
def test_what_a_joint_bears_is_measured_on_after_a_change_of_masses(world, rests):
    model = world.spawn(read(
        link("post") + link("lamp", "0 0 -1 0 0 0") + joint("w", "fixed", "world", "post")
        + joint("j", "revolute", "post", "lamp", axis("0 0 1", NO_WAY))))
    other = world.spawn(read(link("floating", more="<gravity>false</gravity>")), name="other")
    other.set_velocity(Twist() if rests else Twist((1.0, 0.0, 0.0)))
    hinge = model.joint("j")
    hinge.reaction()  # from now on it is measured
    run(world, 2.0)
    assert world.is_at_rest == rests
    lamp = model.links["lamp"]
    heavier = replace(lamp.description.inertial, mass=2.0)
    for _ in range(2):  # the second without a step between
        model.change_link(lamp, heavier, gravity=True)
        assert hinge.reaction()[0] == pytest.approx((0.0, 0.0, -GRAVITY), abs=1e-3)
    run(world, 0.1)
    assert hinge.reaction()[0] == pytest.approx((0.0, 0.0, -2.0 * GRAVITY), abs=1e-3)


def test_what_a_joint_bears_is_measured_on_after_a_motion_that_is_not_finite(world):
    arm = read(link("post") + link("lamp", "0 0 -1 0 0 0") + joint("w", "fixed", "world", "post")
               + joint("j", "revolute", "post", "lamp", axis("0 0 1")))
    lamps = [world.spawn(arm, Pose((x, 0.0, 0.0)), name) for x, name in ((0.0, "m"), (2.0, "o"))]
    for lamp in lamps:
        lamp.joint("j").reaction()
    run(world, 0.2)
    broken = lamps[0].bodies[0]
    broken.engine.change(pybullet.applyExternalForce, broken.links.index["lamp"],
                         (math.nan, 0, 0), (0, 0, 0), pybullet.WORLD_FRAME)
    run(world, 1.0)
    assert lamps[0].has_recovered
    for lamp in lamps:
        force, _ = lamp.joint("j").reaction()
        assert force == pytest.approx((0.0, 0.0, -GRAVITY), abs=1e-3)


def test_a_damped_joint_too_far_from_what_it_holds_has_no_mass_matrix():
    far = "1e9 1e9 1e9 1e9 -1e9 1e9"
    hinge = joint("hinge", "revolute", "frame", "leaf", f"<pose>-0.3 {far[4:]}</pose>" + axis(
        "1e9 1e9 1", "<dynamics><damping>0.5</damping><spring_reference>1e9</spring_reference>"
        "<spring_stiffness>1e9</spring_stiffness></dynamics>"))
    world = World(WorldDescription())
    try:
        world.spawn(read(link("frame", far) + link("leaf", far) + hinge))
        world.step(3)
    finally:
        world.close()


@pytest.mark.parametrize("name", ["x" * 1_000_000, "轮" * 342])
def test_a_joint_with_a_name_that_the_engine_cannot_hold_is_refused(name):
    size = len(name.encode())
    world = World(WorldDescription())
    try:
        with pytest.raises(SimulationError, match=f"names of at most 1023 bytes, not of {size}: "):
            world.spawn(read(link("a") + link("b") + joint(
                name, "revolute", "a", "b", axis("0 0 1"))))
    finally:
        world.close()
