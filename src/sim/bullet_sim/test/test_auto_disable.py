"""Steps are left out where nothing moves, and only there."""

import math
from dataclasses import replace

import numpy as np
import pybullet
import pytest
from snapshots import take_snapshot

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointDescription,
    LinkDescription,
    ModelDescription,
    Plane,
    Sphere,
    Surface,
)
from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.model import Model
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.twist import Twist
from bullet_sim.world import World

SETTLE = 3.0  # s within which all that stands here comes to rest
WHEEL_RADIUS = 0.03  # m


def inertia(mass: float, size: float) -> tuple[float, ...]:
    """Of a cube."""
    moment = mass * size * size / 6
    return (moment, 0.0, 0.0, moment, 0.0, moment)


def body(name: str, shape, mass: float = 1.0, pose: Pose = IDENTITY, **fields) -> LinkDescription:
    return LinkDescription(name, pose, Inertial(mass, IDENTITY, inertia(mass, 0.1)),
                           collisions=(Collision(name, shape),), **fields)


def single(name: str, shape, **fields) -> ModelDescription:
    return ModelDescription(name, links=(body("link", shape, **fields),))


def ground(mu: float = 100.0) -> ModelDescription:
    plane = Collision("plane", Plane((0.0, 0.0, 1.0), (100.0, 100.0)), surface=Surface(mu=mu))
    return ModelDescription("ground", static=True,
                            links=(LinkDescription("link", collisions=(plane,)),))


BOX = single("box", Box((0.1, 0.1, 0.1)))
BALL = single("ball", Sphere(0.05))


def robot() -> ModelDescription:
    """Two wheels, and a skid behind that carries a part of the weight."""
    skid = Collision("skid", Sphere(0.01), Pose((-0.1, 0.0, -0.02)), Surface(mu=0.0))
    base = body("base", Box((0.2, 0.15, 0.03)), 2.0, Pose((0.0, 0.0, WHEEL_RADIUS)))
    base = replace(base, collisions=(*base.collisions, skid),
                   inertial=replace(base.inertial, pose=Pose((-0.04, 0.0, 0.0))))
    links, joints = [base], []
    for side, y in (("left", 0.1), ("right", -0.1)):
        pose = Pose.from_xyz_rpy((0.0, y, WHEEL_RADIUS), (-math.pi / 2, 0.0, 0.0))
        links.append(body(side, Cylinder(WHEEL_RADIUS, 0.02), 0.05, pose))
        joints.append(JointDescription(f"{side}_joint", "continuous", "base", side))
    return ModelDescription("robot", links=tuple(links), joints=tuple(joints))


class DrivenRobot(DiffDrive):
    """The robot's drive; a command counts at once."""

    def __init__(self, world: World):
        self.model = world.spawn(robot())
        joints = (self.model.joint("left_joint"), self.model.joint("right_joint"))
        super().__init__(*joints, DiffDriveParameters(0.2, 2 * WHEEL_RADIUS, 0.0, 5.0))
        self.command(0.0, 0.0)

    def command(self, forward: float, yaw_rate: float) -> None:
        super().command(forward, yaw_rate)
        self.update(0.01)


def pendulum(length: float = 1.0) -> ModelDescription:
    """A bob that swings about y, hung from the world at a height of 2 m."""
    bob = body("bob", Sphere(0.02), pose=Pose((0.0, 0.0, 2.0 - length)))
    hinge = JointDescription("hinge", "revolute", "world", "bob", Pose((0.0, 0.0, length)),
                             axis=(0.0, 1.0, 0.0))
    return ModelDescription("pendulum", links=(bob,), joints=(hinge,))


class Counted:
    """A world, and how often the engine has stepped."""

    def __init__(self):
        self.world = World()
        self.steps = 0

    def run(self, seconds: float) -> int:
        """Goes on for so long; returns how many of the steps the engine did."""
        before = self.steps
        self.world.step(round(seconds / self.world.timestep))
        return self.steps - before

    def settle(self) -> None:
        """Goes on until steps are left out."""
        self.run(SETTLE)
        assert self.run(0.1) == 0, "not at rest"


@pytest.fixture
def counted(monkeypatch):
    made = Counted()
    step = pybullet.stepSimulation

    def count(**options):
        made.steps += 1
        step(**options)

    monkeypatch.setattr(pybullet, "stepSimulation", count)
    yield made
    made.world.close()


# --- at rest

STANDING = {
    "box": lambda w: w.spawn(BOX, Pose((0.3, 0.2, 0.2))),
    "pendulum": lambda w: w.spawn(pendulum()),
    "robot": lambda w: DrivenRobot(w),
    "nothing": lambda w: None,
}


@pytest.mark.parametrize("thing", STANDING)
def test_what_stands_comes_to_rest_and_stays_where_it_is(counted, thing):
    world = counted.world
    world.spawn(ground())
    STANDING[thing](world)
    counted.settle()
    before = take_snapshot(world)
    assert counted.run(60.0) == 0
    assert take_snapshot(world).models == before.models
    assert world.time == pytest.approx(SETTLE + 60.1)


def test_rest_changes_no_result(counted, monkeypatch):
    """A robot that waited for half a minute drives as one that was solved all that time."""
    ends = []
    for leave_out in (True, False):
        world = World()
        if not leave_out:
            monkeypatch.setattr("bullet_sim.physics.auto_disable.REST_SPEED", 0.0)
        world.spawn(ground())
        drive = DrivenRobot(world)
        world.step(30_000)
        start = drive.model.pose
        drive.command(0.1, 0.0)
        world.step(2000)
        ends.append((start.inverse() * drive.model.pose).position)
        world.close()
    assert ends[0] == pytest.approx(ends[1], abs=1e-4)


def test_a_world_is_solved_until_all_of_it_is_still(counted):
    world = counted.world
    world.spawn(ground())
    world.spawn(BOX, Pose((0.0, 0.0, 0.05)))
    counted.settle()
    world.spawn(BALL, Pose((1.0, 0.0, 100.0)))  # falls for 4.5 s
    assert counted.run(4.0) == 4000


# --- what ends it

DISTURBANCES = {
    "motor": lambda w: w.model("robot").joint("left_joint").drive_velocity(1.0, 5.0),
    "effort": lambda w: w.model("robot").joint("left_joint").drive_effort(0.5),
    "joint position": lambda w: w.model("pendulum").joint("hinge").reset(0.5),
    "force": lambda w: w.link("box::link").apply_force((0.0, 0.0, 1000.0)),
    "torque": lambda w: w.link("box::link").apply_force((0.0, 0.0, 0.0), (0.0, 0.0, 50.0)),
    "pose": lambda w: w.model("box").set_pose(Pose((1.0, 0.0, 0.5))),
    "twist": lambda w: w.model("box").set_twist(Twist((0.0, 0.0, 1.0))),
    "something falls on it": lambda w: w.spawn(BALL, Pose((1.0, 0.02, 0.6))),
    "its support goes": lambda w: w.delete("table"),
    "its support is moved": lambda w: w.model("table").set_pose(Pose((5.0, 0.0, 0.0))),
    "gravity": lambda w: w.configure_physics(gravity=(1.0, 0.0, 9.8)),
    "reset": lambda w: w.reset_models(),
    "reset of time": lambda w: w.reset_simulation(),
}


@pytest.mark.parametrize("disturbance", DISTURBANCES)
def test_every_disturbance_ends_it(counted, disturbance):
    world = counted.world
    world.spawn(ground())
    DrivenRobot(world)
    world.spawn(pendulum(), Pose((0.0, 2.0, 0.0)))
    world.spawn(single("table", Box((0.3, 0.3, 0.2))), Pose((1.0, 0.0, 0.1)))
    box = world.spawn(BOX, Pose((1.0, 0.0, 0.4)))  # falls 15 cm on the table
    counted.settle()
    before = take_snapshot(world)
    DISTURBANCES[disturbance](world)
    assert counted.run(0.4) == 400
    moved = {name for name, model in take_snapshot(world).models.items()
             if not _close(model, before.models.get(name))}
    assert moved - {"ball"}, "nothing moved"
    assert box.pose.position[2] > 0.04
    world.configure_physics(gravity=(0.0, 0.0, -9.8))


def _close(model, before) -> bool:
    if before is None:
        return False
    joints = zip(model.joints.values(), before.joints.values(), strict=True)
    return (math.dist(model.pose.position, before.pose.position) < 1e-5
            and math.dist(model.pose.orientation, before.pose.orientation) < 1e-5
            and all(abs(now[0] - then[0]) < 1e-4 for now, then in joints))


def test_a_command_repeated_unchanged_does_not_end_it(counted):
    world = counted.world
    world.spawn(ground())
    drive = DrivenRobot(world)
    counted.settle()
    for _ in range(100):
        drive.command(0.0, 0.0)
        assert counted.run(0.01) == 0
    drive.command(0.001, 0.0)
    assert counted.run(0.01) == 10


def test_looking_does_not_end_it(counted):
    world = counted.world
    world.spawn(ground())
    DrivenRobot(world)
    counted.settle()
    take_snapshot(world)
    world.update_scene()
    world.cast_rays(np.array([[0.0, 0.0, 1.0]]), np.array([[0.0, 0.0, -1.0]]))
    assert counted.run(0.1) == 0


# --- what moves slowly, or not yet, is not at rest

@pytest.mark.parametrize("speed", [0.001, 0.0001])  # the second one is below what counts as still
def test_a_robot_that_creeps_on_command_is_solved_and_arrives(counted, speed):
    world = counted.world
    world.spawn(ground())
    drive = DrivenRobot(world)
    counted.settle()
    start = drive.model.pose.position[0]
    drive.command(speed, 0.0)
    assert counted.run(20.0) == 20_000
    assert drive.model.pose.position[0] - start == pytest.approx(20 * speed, rel=0.2)


def on_a_slope(world) -> Model:
    """A box that a plate holds at 0.3 rad."""
    slope = Pose.from_xyz_rpy((0.0, 3.0, 1.0), (0.0, 0.3, 0.0))
    plate = Collision("plate", Box((2.0, 2.0, 0.1)), surface=Surface(mu=1.0))
    world.spawn(ModelDescription("plate", static=True, links=(
        LinkDescription("link", collisions=(plate,)),)), slope)
    return world.spawn(BOX, slope * Pose((0.0, 0.0, 0.1)))


def test_a_slope_holds_a_box_while_a_ball_rolls_fast(counted):
    """Then steps are solved less exactly; and exactly again when it has stopped."""
    world, rest = counted.world, counted.world._client.auto_disable
    world.spawn(ground())
    held = on_a_slope(world)
    counted.settle()
    ball = world.spawn(ModelDescription("ball", links=(body("ball", Sphere(0.1)),)),
                       Pose((0.0, -3.0, 0.1)))
    ball.set_velocity(Twist((0.5, 0.0, 0.0), (0.0, 5.0, 0.0)))
    start = held.pose.position
    counted.run(5.0)
    assert rest.is_fast
    assert math.dist(held.pose.position, start) < 1e-3
    world.delete("ball")
    counted.settle()
    assert not rest.is_fast


def test_a_slope_holds_a_box_exactly_while_a_robot_drives(counted):
    world, rest = counted.world, counted.world._client.auto_disable
    world.spawn(ground())
    held = on_a_slope(world)
    drive = DrivenRobot(world)
    counted.settle()
    start = held.pose.position
    drive.command(0.2, 0.0)
    counted.run(5.0)
    assert not rest.is_fast
    assert math.dist(held.pose.position, start) < 3e-4


def test_a_motor_against_a_stop_is_solved(counted):
    hinge = JointDescription("hinge", "revolute", "world", "bob", axis=(0.0, 0.0, 1.0),
                             lower=-0.5, upper=0.5)
    arm = ModelDescription("arm", links=(body("bob", Sphere(0.1)),), joints=(hinge,))
    joint = counted.world.spawn(arm).joint("hinge")
    joint.drive_velocity(1.0, 1.0)
    counted.run(SETTLE)
    assert joint.position == pytest.approx(0.5, abs=0.01)
    assert counted.run(1.0) == 1000
    joint.drive_velocity(0.0, 1.0)
    counted.settle()


def test_a_pendulum_at_its_turning_point(counted):
    model = counted.world.spawn(pendulum())
    hinge = model.joint("hinge")
    hinge.reset(0.02)  # lets go from there: 0.063 rad/s at its greatest
    swung = []
    for _ in range(200):
        assert counted.run(0.05) == 50
        swung.append(hinge.position)
    assert min(swung) == pytest.approx(-0.02, rel=0.1)
    assert max(swung[100:]) == pytest.approx(0.02, rel=0.1)


def test_a_slow_pendulum_at_its_turning_point(counted):
    """Ten metres long, a period of 6.3 s: nearly still for the whole of a look."""
    model = counted.world.spawn(pendulum(10.0))
    hinge = model.joint("hinge")
    hinge.reset(0.05)
    assert counted.run(8.0) == 8000
    assert abs(hinge.position) < 0.051


def test_a_ball_that_rolls_slowly_goes_on(counted):
    world = counted.world
    world.spawn(ground())
    ball = world.spawn(BALL, Pose((0.0, 0.0, 0.05)))
    counted.run(0.5)
    ball.set_twist(Twist((0.002, 0.0, 0.0), (0.0, 0.04, 0.0)))
    start = ball.pose.position[0]
    assert counted.run(10.0) == 10_000
    assert ball.pose.position[0] - start == pytest.approx(0.02, rel=0.2)


def test_a_pole_that_begins_to_fall_is_solved(counted):
    """From 0.1 mrad beside upright it takes half a second to turn at 0.7 mrad/s, and falls."""
    hinge = counted.world.spawn(pendulum(-1.0)).joint("hinge")
    hinge.reset(1e-4)
    counted.run(4.0)
    assert hinge.position > 1.0


@pytest.mark.parametrize("step", [1e-5, 1e-4, 0.002])
def test_a_pendulum_does_not_stop_where_it_turns_however_short_a_step_is(counted, step):
    world = counted.world
    world.configure_physics(max_step_size=step)
    hinge = world.spawn(pendulum()).joint("hinge")
    hinge.reset(0.02)
    counted.run(0.5)  # a quarter of its period
    assert abs(hinge.position) < 0.002


def test_a_box_that_drifts_slowly_goes_on(counted):
    world = counted.world
    world.configure_physics(gravity=(0.0, 0.0, 0.0))
    box = world.spawn(BOX)
    box.set_twist(Twist((0.001, 0.0, 0.0)))
    assert counted.run(10.0) == 10_000
    assert box.pose.position == pytest.approx((0.01, 0.0, 0.0), abs=1e-6)


def test_a_weightless_link_floats_and_moves_when_pushed(counted):
    world = counted.world
    model = world.spawn(single("balloon", Sphere(0.1), gravity=False), Pose((0.0, 0.0, 1.0)))
    counted.run(SETTLE)
    assert model.pose.position == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    model.links["link"].apply_force((100.0, 0.0, 0.0))
    counted.run(1.0)
    assert model.pose.position == pytest.approx((0.1, 0.0, 1.0), abs=1e-3)


def test_a_weightless_link_floats_when_gravity_changes(counted):
    world = counted.world
    model = world.spawn(single("balloon", Sphere(0.1), gravity=False), Pose((0.0, 0.0, 1.0)))
    world.configure_physics(gravity=(0.0, 0.0, -1.6))
    counted.run(1.0)
    assert model.pose.position == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)


# --- heaps

def crowd(world: World, count: int = 9, surface: Surface = Surface()) -> list:
    """Barrels on wide feet, put closer than their feet allow, as a saved world has them."""
    foot = Collision("foot", Cylinder(0.5, 0.03), Pose((0.0, 0.0, 0.015)), surface)
    drum = Collision("drum", Cylinder(0.3, 1.0), Pose((0.0, 0.0, 0.53)), surface)
    link = replace(body("link", Sphere(0.1)), collisions=(foot, drum), inertial=Inertial(
        1.0, Pose((0.0, 0.0, 0.5)), inertia(1.0, 0.8)))
    barrel = ModelDescription("barrel", links=(link,))
    return [world.spawn(barrel, Pose(((number % 3) * 0.65, number // 3 * 0.65, 0.0)), f"b{number}")
            for number in range(count)]


def test_barrels_on_one_anothers_feet_come_to_rest(counted):
    world = counted.world
    world.spawn(ground(1.0))
    crowd(world)
    counted.run(4.0)
    assert counted.run(1.0) == 0, "never sleeps"


def test_one_of_a_heap_that_is_pushed_moves_and_the_heap_rests_again(counted):
    world = counted.world
    world.spawn(ground(1.0))
    barrels = crowd(world, 2)
    counted.run(4.0)
    assert counted.run(1.0) == 0
    before = barrels[1].pose.position[0]
    barrels[1].set_velocity(Twist((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    counted.run(0.3)
    assert barrels[1].pose.position[0] > before + 0.01


def test_a_force_on_one_of_a_disabled_heap_moves_it(counted):
    world = counted.world
    world.spawn(ground(1.0))
    barrels = crowd(world, 2)
    counted.run(4.0)
    assert counted.run(1.0) == 0
    before = barrels[1].pose.position[0]
    for _ in range(300):
        barrels[1].link("link").apply_force((40.0, 0.0, 0.0))
        world.step()
    assert barrels[1].pose.position[0] > before + 0.02


def test_one_of_a_disabled_heap_is_put_elsewhere_in_flight_and_another_deleted(counted):
    world = counted.world
    world.spawn(ground(1.0))
    barrels = crowd(world, 3)
    counted.run(4.0)
    assert counted.run(1.0) == 0
    barrels[2].set_velocity(Twist((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    world.delete("b2")
    barrels[1].set_pose(Pose((5.0, 0.0, 3.0)))
    barrels[1].set_velocity(Twist((2.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    counted.run(0.5)
    assert barrels[1].pose.position[0] == pytest.approx(6.0, abs=0.02)
    assert barrels[1].pose.position[2] == pytest.approx(3.0 - 4.9 * 0.25, abs=0.03)


def test_what_slides_into_a_disabled_heap_moves_it(counted):
    world = counted.world
    world.spawn(ground(1.0))
    barrels = crowd(world, 2)
    crate = world.spawn(single("crate", Box((0.4, 0.4, 0.4)), mass=20.0), Pose((-1.5, 0.0, 0.2)))
    counted.run(4.0)
    assert counted.run(1.0) == 0
    before = [barrel.pose.position[0] for barrel in barrels]
    crate.set_velocity(Twist((4.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    counted.run(1.0)
    assert all(barrel.pose.position[0] > x + 0.02
               for barrel, x in zip(barrels, before, strict=True))


def test_what_is_knocked_out_of_a_disabled_heap_flies_on(counted):
    world = counted.world
    world.spawn(ground(1.0))
    barrels = crowd(world, 2, Surface(mu=0.1, restitution=0.9))
    link = body("link", Sphere(0.2), 5.0, gravity=False)
    rubber = replace(link.collisions[0], surface=Surface(restitution=0.9))
    ball = world.spawn(ModelDescription("ball", links=(replace(link, collisions=(rubber,)),)),
                       Pose((-1.5, 0.0, 0.5)))
    counted.run(4.0)
    assert counted.run(1.0) == 0
    ball.set_velocity(Twist((4.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    counted.run(0.6)
    assert all(barrel.twist.linear[0] > 3.0 for barrel in barrels)


def test_what_a_disabled_heap_stands_on_can_be_taken_away(counted):
    world = counted.world
    world.spawn(ground(1.0))
    world.spawn(replace(single("slab", Box((6.0, 6.0, 1.0))), static=True), Pose((0, 0, 0.5)))
    barrels = crowd(world, 2)
    for barrel in barrels:
        x, y, _ = barrel.pose.position
        barrel.set_pose(Pose((x, y, 1.0)))
    counted.run(4.0)
    assert counted.run(1.0) == 0
    world.delete("slab")
    counted.run(0.4)
    assert all(barrel.pose.position[2] < 0.9 for barrel in barrels)


def test_many_boxes_sunk_into_the_ground_sleep_soon_and_one_that_is_hit_moves(counted):
    """A quarter of a second after they are out of the ground, at 0.2 m/s."""
    world = counted.world
    world.spawn(ground(1.0))
    boxes = [world.spawn(BOX, Pose((n % 8 * 0.1, n // 8 * 0.1, 0.04)), f"box{n}")
             for n in range(64)]
    counted.run(0.45)
    assert all(abs(box.pose.position[2] - 0.05) < 0.01 for box in boxes)
    assert counted.run(0.6) < 600, "awake for longer than half a second"
    before = boxes[7].pose.position[0]
    ball = world.spawn(single("ball", Sphere(0.05), mass=5.0), Pose((1.0, 0.0, 0.06)))
    ball.set_velocity(Twist((-4.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    counted.run(0.3)
    assert boxes[7].pose.position[0] < before - 0.003


def test_a_model_that_must_not_be_disabled_goes_on(counted):
    """`<allow_auto_disable>0`: it trembles for as long as it likes."""
    # conforms: sdf model/allow_auto_disable
    world = counted.world
    world.spawn(ground(1.0))
    for barrel in crowd(world, 4):
        barrel.description = replace(barrel.description, auto_disables=False)
        barrel.note_weightless()
    assert counted.run(3.0) == 3000
