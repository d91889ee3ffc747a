"""Physics against known answers: laws, geometry, and a differential drive on the flat."""

import math
from dataclasses import replace

import pytest
from snapshots import take_snapshot

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointDescription,
    LightDescription,
    LinkDescription,
    ModelDescription,
    PhysicsDescription,
    Plane,
    Surface,
    WorldDescription,
)
from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.sensors.odometry import WheelOdometry, true_odometry
from bullet_sim.tick_rate import TickRate
from bullet_sim.twist import Twist
from bullet_sim.world import World

GRAVITY = 9.8
ROLLING = Surface(mu=0.1, mu2=0.1)


def is_due(rate: TickRate, tick: int) -> bool:
    return rate.next_tick(tick - 1) == tick


def ground(mu: float = 100.0, tilt: float = 0.0) -> ModelDescription:
    plane = Collision("plane", Plane((0.0, 0.0, 1.0), (100.0, 100.0)), surface=Surface(mu=mu))
    return ModelDescription("ground", Pose.from_xyz_rpy((0, 0, 0), (0, tilt, 0)), static=True,
                            links=(LinkDescription("link", collisions=(plane,)),))


def box_link(name: str, size, mass: float, pose: Pose = IDENTITY, mu: float = 1.0):
    x, y, z = size
    inertia = (mass * (y * y + z * z) / 12, 0.0, 0.0, mass * (x * x + z * z) / 12, 0.0,
               mass * (x * x + y * y) / 12)
    return LinkDescription(name, pose, Inertial(mass, IDENTITY, inertia), collisions=(
        Collision(f"{name}_collision", Box(size), surface=Surface(mu=mu)),))


def box(size=(0.2, 0.2, 0.1), mass: float = 1.0, mu: float = 1.0) -> ModelDescription:
    return ModelDescription("box", links=(box_link("link", size, mass, mu=mu),))


def robot() -> ModelDescription:
    """The waffle's drive train: its masses, wheels and casters, links already lumped."""
    base = box_link("base", (0.266, 0.266, 0.094), 2.05)
    casters = tuple(
        Collision(f"caster_{y}", Box((0.03, 0.02, 0.009)),
                  Pose((-0.177, y, 0.005)), ROLLING)
        for y in (-0.064, 0.064))
    body = replace(base.collisions[0], pose=Pose((-0.064, 0.0, 0.057)))
    base = replace(base, inertial=replace(base.inertial, pose=Pose((-0.05, 0.0, 0.06))),
                   collisions=(body, *casters))
    tyre = Collision("tyre", Cylinder(0.033, 0.018), surface=ROLLING)
    wheel_inertial = Inertial(0.0285, IDENTITY, (1.2e-5, 0.0, 0.0, 1.2e-5, 0.0, 1.6e-5))
    links, joints = [base], []
    for side, y in (("left", 0.144), ("right", -0.144)):
        pose = Pose.from_xyz_rpy((0.0, y, 0.033), (-1.57, 0.0, 0.0))
        links.append(LinkDescription(f"wheel_{side}", pose, wheel_inertial, collisions=(tyre,)))
        joints.append(JointDescription(f"{side}_joint", "continuous", "base", f"wheel_{side}"))
    return ModelDescription("robot", links=tuple(links), joints=tuple(joints))


def run(world: World, seconds: float) -> None:
    for _ in range(round(seconds / world.timestep)):
        world.step()


def test_free_fall_follows_the_law(world):
    model = world.spawn(box(), Pose((1.0, 2.0, 10.0)))
    run(world, 1.0)
    # Semi-implicit Euler falls g dt t / 2 further than the closed form.
    fallen = 0.5 * GRAVITY * 1.0 * (1.0 + world.timestep)
    assert model.pose.position == pytest.approx((1.0, 2.0, 10.0 - fallen), abs=1e-6)
    assert model.twist.linear[2] == pytest.approx(-GRAVITY, abs=1e-6)


@pytest.mark.parametrize("tilt_over_friction_angle, slides", [(0.93, False), (1.07, True)])
def test_box_on_a_slope_at_its_friction_angle(world, tilt_over_friction_angle, slides):
    mu = 0.5
    tilt = math.atan(mu) * tilt_over_friction_angle
    world.spawn(ground(tilt=tilt))
    start = Pose.from_xyz_rpy((0, 0, 0), (0, tilt, 0)) * Pose((0.0, 0.0, 0.05))
    model = world.spawn(box((0.4, 0.4, 0.1), mu=mu), start)
    run(world, 0.5)
    settled = model.pose
    run(world, 1.0)
    moved = math.dist(model.pose.position, settled.position)
    if not slides:
        assert moved < 0.002
        return
    # From rest: a = g (sin tilt - mu cos tilt); in the second from t = 0.5 to 1.5 s.
    a = GRAVITY * (math.sin(tilt) - mu * math.cos(tilt))
    assert moved == pytest.approx(a * (1.5 ** 2 - 0.5 ** 2) / 2, rel=0.05)


def test_a_box_comes_to_rest_on_the_ground_at_half_its_height(world):
    world.spawn(ground())
    model = world.spawn(box(), Pose((0.0, 0.0, 0.3)))
    run(world, 2.0)
    assert model.pose.position[2] == pytest.approx(0.05, abs=0.001)
    assert model.twist.linear == pytest.approx((0, 0, 0), abs=1e-3)


def drive(world: World, forward: float, yaw_rate: float, seconds: float):
    """Drive for some seconds after one of ramping up; true and counted odometry of that time."""
    world.spawn(ground())
    model = world.spawn(robot())
    left, right = model.joint("left_joint"), model.joint("right_joint")
    geometry = DiffDriveParameters(0.288, 0.066, 1.0, 10.0)
    train, counted = DiffDrive(left, right, geometry), WheelOdometry(0.288, 0.066)
    tick_rate = TickRate(30.0, world.timestep)
    train.command(forward, yaw_rate)
    start, turned, last_yaw = None, 0.0, 0.0
    for tick in range(round((seconds + 1.0) / world.timestep)):
        if tick == round(1.0 / world.timestep):
            start = model.pose
            counted.restart(world.time)
            turned = 0.0
        if is_due(tick_rate, world.tick):
            train.update(1 / 30)
        world.step()
        counted.update(world.time, left.velocity, right.velocity)
        yaw = model.pose.rpy()[2]
        turned += (yaw - last_yaw + math.pi) % (2 * math.pi) - math.pi
        last_yaw = yaw
    return start, model, turned, counted.sample()


def test_commanded_speed_is_driven_within_one_percent(world):
    start, model, _, counted = drive(world, 0.15, 0.0, 10.0)
    driven = math.dist(start.position, model.pose.position)
    assert driven == pytest.approx(1.5, rel=0.01)
    assert math.hypot(*counted.pose.position) == pytest.approx(driven, rel=0.01)
    assert true_odometry(world, model).forward == pytest.approx(0.15, rel=0.01)


def test_commanded_turn_in_place_within_one_percent(world):
    _, model, turned, counted = drive(world, 0.0, 0.5, 10.0)
    assert turned == pytest.approx(5.0, rel=0.01)
    assert counted.yaw_rate == pytest.approx(0.5, rel=0.01)
    assert true_odometry(world, model).yaw_rate == pytest.approx(0.5, rel=0.01)


def test_counted_odometry_of_an_arc_is_the_true_one_within_one_percent(world):
    start, model, turned, counted = drive(world, 0.2, 0.25, 8.0)
    true = start.inverse() * model.pose
    length = 0.2 * 8.0
    assert math.dist(true.position[:2], counted.pose.position[:2]) < 0.01 * length
    assert counted.pose.rpy()[2] == pytest.approx(turned, rel=0.01)


def test_a_fixed_link_stays_where_the_description_puts_it(world):
    model = world.spawn(robot(), Pose.from_xyz_rpy((1, 2, 0), (0, 0, 1.0)))
    for link in model.links.values():
        expected = model.initial_pose * link.description.pose
        assert link.pose.position == pytest.approx(expected.position, abs=1e-6)
        assert abs(sum(a * b for a, b in zip(link.pose.orientation, expected.orientation,
                                             strict=True))) == pytest.approx(1.0, abs=1e-6)


def test_joint_frame_off_the_link_origin(world):
    """A pendulum whose joint sits at the link's end, as SDF allows."""
    arm = box_link("arm", (0.02, 0.02, 1.0), 1.0, Pose((0.0, 0.0, 2.0)))
    hinge = JointDescription("hinge", "revolute", "world", "arm", Pose((0.0, 0.0, 0.5)),
                             axis=(0.0, 1.0, 0.0))
    model = world.spawn(ModelDescription("pendulum", links=(arm,), joints=(hinge,)))
    model.joint("hinge").reset(math.pi / 2)
    assert model.links["arm"].pose.position == pytest.approx((-0.5, 0.0, 2.5), abs=1e-6)
    run(world, 0.01)
    # A rod of length L let go level turns with 3 g / (2 L).
    assert model.joint("hinge").velocity == pytest.approx(-1.5 * GRAVITY * 0.01, rel=0.01)


def test_effort_accelerates_a_joint(world):
    arm = box_link("arm", (0.02, 0.02, 1.0), 1.0)
    hinge = JointDescription("spin", "continuous", "world", "arm", axis=(0.0, 0.0, 1.0))
    model = world.spawn(ModelDescription("spinner", links=(arm,), joints=(hinge,)))
    inertia = model.links["arm"].description.inertial.inertia[5]
    for _ in range(100):
        model.joint("spin").drive_effort(1e-4)
        world.step()
    assert model.joint("spin").velocity == pytest.approx(1e-4 / inertia * 0.1, rel=0.01)


def test_a_small_wheel_turns_faster_than_the_engines_own_bound(world):
    joint = world.spawn(robot()).joint("left_joint")
    joint.drive_velocity(300.0, 5.0)
    run(world, 0.5)
    assert joint.velocity == pytest.approx(300.0, rel=0.01)


def test_a_joint_without_a_position_says_so(world):
    links = (box_link("a", (0.1, 0.1, 0.1), 1.0), box_link("b", (0.1, 0.1, 0.1), 1.0))
    gear = JointDescription("j", "gearbox", "a", "b")
    model = world.spawn(ModelDescription("m", links=links, joints=(gear,)))
    with pytest.raises(SimulationError, match="joint 'j' of model m is of type gearbox"):
        model.joint("j")


def test_gravity_off_floats(world):
    link = replace(box_link("link", (0.1, 0.1, 0.1), 2.0), gravity=False)
    model = world.spawn(ModelDescription("balloon", links=(link,)), Pose((0, 0, 1.0)))
    run(world, 0.5)
    assert model.pose.position == pytest.approx((0, 0, 1.0), abs=1e-6)


def test_pause_means_time_and_motion_stand_still(world):
    model = world.spawn(box(), Pose((0, 0, 5.0)))
    run(world, 0.1)
    world.paused = True
    before = take_snapshot(world)
    run(world, 0.1)
    assert take_snapshot(world) == before
    world.paused = False
    world.step()
    assert world.tick == 101
    assert model.pose.position[2] < before.models["box"].pose.position[2]


def test_reset_world_keeps_time_and_reset_simulation_does_not(world):
    model = world.spawn(box(), Pose((0, 0, 5.0)))
    run(world, 0.2)
    world.reset_models()
    assert world.time == pytest.approx(0.2)
    assert model.pose.position == pytest.approx((0, 0, 5.0), abs=1e-9)
    assert model.twist.linear == pytest.approx((0, 0, 0))
    run(world, 0.2)
    world.reset_simulation()
    assert world.tick == 0
    assert model.pose.position == pytest.approx((0, 0, 5.0), abs=1e-9)


def test_set_pose_and_twist_are_read_back(world):
    model = world.spawn(robot(), Pose((0, 0, 1.0)))
    pose = Pose.from_xyz_rpy((3.0, -1.0, 2.0), (0.1, -0.2, 0.7))
    model.set_pose(pose)
    model.set_twist(Twist((0.3, 0.2, 0.1), (0.0, 0.0, 0.5)))
    assert model.pose.position == pytest.approx(pose.position, abs=1e-6)
    assert model.pose.rpy() == pytest.approx(pose.rpy(), abs=1e-6)
    assert model.twist.linear == pytest.approx((0.3, 0.2, 0.1), abs=1e-6)
    assert model.twist.angular == pytest.approx((0.0, 0.0, 0.5), abs=1e-6)


def test_a_zero_twist_stops_the_joints_too(world):
    model = world.spawn(robot(), Pose((0, 0, 1.0)))
    model.joint("left_joint").reset(0.5, velocity=5.0)
    model.set_twist(Twist())
    assert model.joint("left_joint").velocity == 0.0
    assert model.joint("left_joint").position == pytest.approx(0.5)


def test_a_model_that_cannot_be_shown_leaves_nothing_behind(world):
    lamp = LightDescription("lamp")
    link = replace(box_link("link", (0.1, 0.1, 0.1), 1.0), lights=(lamp, lamp))
    with pytest.raises(SimulationError, match="already there"):
        world.spawn(ModelDescription("twice_lit", links=(link,)))
    assert (world.models, world.scene.lights, world.scene.nodes) == ({}, {}, {})
    world.spawn(box(), name="twice_lit")


def test_wheels_without_size_are_an_error(world):
    model = world.spawn(robot())
    joints = model.joint("left_joint"), model.joint("right_joint")
    with pytest.raises(SimulationError, match=r"wheel diameter 0 and separation 0\.3"):
        DiffDrive(*joints, DiffDriveParameters(0.3, 0))


def test_a_static_model_can_be_moved_and_still_collides(world):
    floor = world.spawn(ModelDescription("floor", static=True, links=(
        box_link("link", (1.0, 1.0, 0.1), 1.0),)))
    floor.set_pose(Pose((5.0, 0.0, 1.0)))
    assert floor.pose.position == (5.0, 0.0, 1.0)
    model = world.spawn(box(), Pose((5.0, 0.0, 1.2)))
    run(world, 1.0)
    assert model.pose.position[2] == pytest.approx(1.1, abs=0.002)


def test_the_same_run_twice_is_bit_identical():
    def once():
        world = World()
        world.spawn(ground())
        model = world.spawn(robot())
        for name, rate in (("left_joint", 4.0), ("right_joint", 5.0)):
            model.joint(name).drive_velocity(rate, 10.0)
        run(world, 1.0)
        result = take_snapshot(world)
        world.close()
        return result
    assert once() == once()


def test_names_are_unique_and_errors_list_what_there_is(world):
    world.spawn(box())
    with pytest.raises(SimulationError, match="'box' is already there"):
        world.spawn(box())
    with pytest.raises(UnknownName, match="no model named 'bix'; there are: box"):
        world.model("bix")
    with pytest.raises(UnknownName, match="no joint of model box named 'j'"):
        world.model("box").joint("j")
    world.delete("box")
    assert world.models == {}


def test_a_deleted_model_no_longer_collides(world):
    world.spawn(ground())
    model = world.spawn(box(), Pose((0, 0, 0.06)))
    run(world, 0.1)
    world.delete("ground")
    run(world, 1.0)
    assert model.pose.position[2] < -1.0


def test_time_is_a_whole_number_of_steps():
    world = World(WorldDescription(physics=PhysicsDescription(max_step_size=0.002)))
    run(world, 0.5)
    assert (world.tick, world.time) == (250, 0.5)
    world.close()


def test_schedule_keeps_its_long_run_rate():
    tick_rate = TickRate(30.0, 0.001)
    due = [tick for tick in range(1, 3001) if is_due(tick_rate, tick)]
    assert due[:3] == [34, 67, 100]
    assert len(due) == 90
    every = TickRate(0.0, 0.001)
    tick_rate.restart(1)
    assert [tick for tick in range(2, 101) if is_due(tick_rate, tick)] == [35, 68]
    assert (tick_rate.next_tick(2), tick_rate.next_tick(35), tick_rate.next_tick(36)) == (
        35,
        68,
        68,
    )
    tick_rate.restart(100, 0.01)  # steps ten times as long
    assert [tick for tick in range(101, 111) if is_due(tick_rate, tick)] == [104, 107, 110]
    assert all(is_due(every, tick) for tick in range(1, 10))


def test_counted_odometry_of_half_a_turn_is_a_chord_of_its_circle():
    counted = WheelOdometry(wheel_separation=0.5, wheel_diameter=0.2)
    counted.update(2.0, 0.0, 2.5)  # the right wheel goes 0.5 m, the left one stands
    pose = counted.sample().pose
    assert pose.rpy()[2] == pytest.approx(1.0)
    assert pose.position == pytest.approx((0.25 * math.cos(0.5), 0.25 * math.sin(0.5), 0.0))
