"""Drives of a base without ros_control: motors' targets, and the ways that they go."""

import math

import pytest
from rigs import body, hinge, rig

from bullet_sim.description import SensorDescription, WorldDescription
from bullet_sim.drives.diff_drive import DiffDriveParameters, turns_backwards
from bullet_sim.drives.force_based_move import ForceDrive, ForceGains
from bullet_sim.drives.kobuki import Kobuki
from bullet_sim.drives.planar import PlanarDrive, PlanarOdometry
from bullet_sim.drives.tricycle import Tricycle, TricycleParameters
from bullet_sim.errors import SimulationError
from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.sensors.imu import ImuSensor
from bullet_sim.twist import Twist
from bullet_sim.world import World


@pytest.fixture
def world():
    made = World(WorldDescription(gravity=(0.0, 0.0, 0.0)))
    yield made
    made.close()


def run(world: World, seconds: float, update) -> None:
    for _ in range(round(seconds / world.timestep)):
        update()
        world.step()


def heading(yaw: float) -> Pose:
    return Pose((0.0, 0.0, 0.0), quaternion_from_rpy(0.0, 0.0, yaw))


# --- tricycle

def tricycle(world: World, **parameters):
    joints = world.spawn(rig(hinge("steering"), hinge("wheel", (0, 1, 0)))).joints
    drive = Tricycle(joints["steering"], joints["wheel"],
                     TricycleParameters(wheel_diameter=0.2, torque=4.0, **parameters))
    return drive, joints["steering"], joints["wheel"]


def test_a_tricycle_turns_its_wheel_by_rim_speed_and_puts_the_steering(world):
    drive, steering, wheel = tricycle(world)
    drive.command(0.5, 0.3)
    drive.update(0.01)
    assert wheel.motor == (5.0, 4.0)  # rad/s, N m
    assert steering.position == pytest.approx(0.3)
    drive.stop()
    drive.update(0.01)
    assert wheel.motor == (0.0, 4.0)
    assert steering.position == pytest.approx(0.0)


@pytest.mark.parametrize("side", [1, -1])
def test_the_steering_goes_to_a_right_angle_at_most(world, side):
    drive, steering, _ = tricycle(world)
    drive.command(0.0, side * 9.0)
    drive.update(0.01)
    assert steering.position == pytest.approx(side * math.pi / 2)


def test_a_tricycle_speeds_up_and_brakes_by_its_own_ramps(world):
    drive, _, wheel = tricycle(world, acceleration=2.0, deceleration=5.0, speed_tolerance=0.15)
    rates = []
    for speed, updates in ((0.05, 3), (0.0, 2)):
        drive.command(speed, 0.0)  # 0.5 rad/s, then 0
        for _ in range(updates):
            drive.update(0.1)
            rates.append(wheel.motor[0])
    assert rates == pytest.approx([0.2, 0.4, 0.5, 0.0, 0.0])
    drive.command(-1.0, 0.0)
    drive.update(0.1)
    assert wheel.motor[0] == pytest.approx(-0.2)


def test_the_steering_turns_at_its_speed_until_it_is_there(world):
    drive, steering, _ = tricycle(world, steering_speed=2.0, angle_tolerance=0.01)
    drive.command(0.0, -0.4)
    run(world, 0.1, lambda: drive.update(world.timestep))
    assert steering.position == pytest.approx(-0.2, abs=5e-3)
    run(world, 0.2, lambda: drive.update(world.timestep))
    assert steering.position == pytest.approx(-0.4, abs=0.01)
    assert steering.motor == (0.0, 4.0)


def test_a_tricycle_has_a_wheel(world):
    joints = world.spawn(rig(hinge("a"), hinge("b"))).joints
    with pytest.raises(SimulationError, match=r"diameter 0\.0 must be more than 0 m"):
        Tricycle(joints["a"], joints["b"], TricycleParameters(wheel_diameter=0.0))


# --- planar drive

def test_a_planar_drive_goes_by_speed_and_time_in_its_heading(world):
    model = world.spawn(body("a"), heading(math.pi / 2))
    drive, odometry = PlanarDrive(model), PlanarOdometry(world, model)
    drive.command(1.0, 0.5, 0.0)
    run(world, 0.4, drive.update)
    assert model.pose.position == pytest.approx((-0.2, 0.4, 0.0), abs=2e-3)
    reading = odometry.sample()
    assert (reading.forward, reading.leftward) == pytest.approx((1.0, 0.5), abs=5e-3)
    assert odometry.sample().forward == 0.0  # no time has passed
    drive.stop()
    run(world, 0.1, drive.update)
    assert model.pose.position == pytest.approx((-0.2, 0.4, 0.0), abs=3e-3)


def test_a_planar_drive_that_turns_goes_in_a_circle(world):
    model = world.spawn(body("a"), heading(3.0))  # and across half a turn
    drive, odometry = PlanarDrive(model), PlanarOdometry(world, model)
    drive.command(0.6, 0.0, 2.0)
    run(world, 0.5, drive.update)
    x, y, _ = model.pose.position
    radius, end = 0.3, 4.0
    assert (x, y) == pytest.approx((radius * (math.sin(end) - math.sin(3.0)),
                                    radius * (math.cos(3.0) - math.cos(end))), abs=2e-3)
    assert odometry.sample().yaw_rate == pytest.approx(2.0, abs=5e-3)


def test_a_planar_drive_that_stands_lets_the_world_rest(world):
    drive = PlanarDrive(world.spawn(body("a")))
    run(world, 0.6, drive.update)
    assert world.is_at_rest


# --- force-based move: v(t) = wanted (1 - exp(-gain t / m)), of 1 kg and 0.01 kg m^2

GAINS = ForceGains(forward=10.0, leftward=20.0, yaw=0.1)


def test_what_lacks_in_velocity_is_pushed_for(world):
    link = world.spawn(body("a"), heading(math.pi / 2)).links["l"]
    drive = ForceDrive(world, link, GAINS, math.inf)
    drive.command(1.0, 0.5, 0.0)
    run(world, 0.1, drive.update)
    forward, leftward = 1.0 - math.exp(-1.0), 0.5 * (1.0 - math.exp(-2.0))
    assert link.twist.linear == pytest.approx((-leftward, forward, 0.0), abs=0.01)
    reading = drive.odometry()
    assert (reading.forward, reading.leftward) == pytest.approx((forward, leftward), abs=0.01)
    way = 0.1 - (1.0 - math.exp(-1.0)) / 10.0  # counted from where it was spawned
    assert reading.pose.position[0] == pytest.approx(way, abs=2e-3)


def test_a_torque_turns_it(world):
    link = world.spawn(body("a")).links["l"]
    drive = ForceDrive(world, link, GAINS, math.inf)
    drive.command(0.0, 0.0, 2.0)
    run(world, 0.1, drive.update)
    assert link.twist.angular[2] == pytest.approx(2.0 * (1.0 - math.exp(-1.0)), abs=0.02)


def test_an_old_command_brakes(world):
    link = world.spawn(body("a")).links["l"]
    drive = ForceDrive(world, link, ForceGains(forward=100.0), timeout=0.2)
    drive.command(1.0, 0.0, 0.0)
    run(world, 0.2, drive.update)
    assert link.twist.linear[0] == pytest.approx(1.0, abs=0.01)
    run(world, 0.1, drive.update)
    assert link.twist.linear[0] == pytest.approx(0.0, abs=0.01)


def test_a_reset_force_drive_counts_from_zero_and_stands(world):
    link = world.spawn(body("a")).links["l"]
    drive = ForceDrive(world, link, GAINS, math.inf)
    drive.command(1.0, 0.0, 0.0)
    run(world, 0.1, drive.update)
    assert drive.odometry().pose.position[0] > 0.01
    drive.reset()
    assert drive.odometry().pose.position == (0.0, 0.0, 0.0)
    world.reset_models()
    run(world, 0.6, drive.update)
    assert world.is_at_rest


# --- Kobuki: wheels of 0.07 m, 0.23 m apart; its gyroscope is on a body of its own

def kobuki(world: World, turning: float = 0.0, **options):
    joints = world.spawn(rig(hinge("left", (0, 1, 0)), hinge("right", (0, 1, 0)))).joints
    spinner = world.spawn(body("spinner"), Pose((5.0, 0.0, 0.0)))
    spinner.set_velocity(Twist(angular=(0.0, 0.0, turning)))
    imu = ImuSensor(world, spinner.links["l"], SensorDescription("imu", "imu"))
    geometry = {"torque": 10.0, "wheel_separation": 0.23, "wheel_diameter": 0.07, "timeout": 0.6}
    return Kobuki(world, joints["left"], joints["right"], imu, **(geometry | options))


def test_kobukis_wheels_turn_by_speed_and_yaw_rate(world):
    robot = kobuki(world)
    robot.command(0.3, 1.0)
    robot.update()
    left, right = (joint.motor for joint in robot.wheels)
    assert left == pytest.approx(((0.3 - 0.115) / 0.035, 10.0))
    assert right == pytest.approx(((0.3 + 0.115) / 0.035, 10.0))


def test_kobuki_counts_its_way_by_wheels_and_its_turn_by_gyroscope(world):
    robot = kobuki(world, turning=2.0, torque=1000.0)  # at once at its speed
    robot.command(0.5, 0.0)
    run(world, 0.5, robot.update)
    robot.update()
    reading = robot.odometry()
    assert reading.pose.rpy()[2] == pytest.approx(1.0, abs=5e-3)
    assert reading.pose.position[:2] == pytest.approx(
        (0.25 * math.sin(1.0), 0.25 * (1.0 - math.cos(1.0))), abs=3e-3)
    assert (reading.forward, reading.yaw_rate) == pytest.approx((0.5, 2.0), abs=5e-3)
    assert robot.imu_reading().angular_velocity[2] == pytest.approx(2.0, abs=5e-3)
    robot.reset_odometry()
    assert robot.odometry().pose == Pose()


def test_kobuki_stops_after_the_timeout(world):
    robot = kobuki(world, timeout=0.1)
    robot.command(0.35, 0.0)
    run(world, 0.09, robot.update)
    assert robot.wheels[0].motor[0] == pytest.approx(10.0)
    run(world, 0.02, robot.update)
    assert [joint.motor[0] for joint in robot.wheels] == [0.0, 0.0]


def test_kobuki_without_power_stands(world):
    robot = kobuki(world)
    robot.switch(False)
    robot.command(0.35, 0.0)
    robot.update()
    assert robot.wheels[0].motor[0] == 0.0
    robot.switch(True)
    robot.command(0.35, 0.0)
    robot.update()
    assert robot.wheels[0].motor[0] == pytest.approx(10.0)


def test_a_reset_kobuki_is_as_just_switched_on(world):
    robot = kobuki(world, turning=2.0)
    robot.switch(False)
    run(world, 0.1, robot.update)
    robot.reset()
    assert robot.odometry().pose == Pose()
    assert robot.imu_reading().angular_velocity[2] == pytest.approx(2.0, abs=5e-3)
    robot.command(0.35, 0.0)
    robot.update()
    assert robot.wheels[0].motor[0] == pytest.approx(10.0)


@pytest.mark.parametrize("wrong", ["wheel_separation", "wheel_diameter"])
def test_kobuki_has_lengths(world, wrong):
    with pytest.raises(SimulationError, match="must both be more than 0 m"):
        kobuki(world, **{wrong: 0.0})


# --- differential drive

@pytest.mark.parametrize("axis, side, separation, diameter, backwards", [
    ((0, 1, 0), 0.2, 0.4, 0.1, False), ((0, 1, 0), -0.2, 0.4, 0.1, True),
    ((0, -1, 0), 0.2, 0.4, 0.1, True), ((0, 1, 0), -0.2, -0.4, 0.1, False),
    ((0, 1, 0), 0.2, 0.4, -0.1, True)])
def test_a_left_wheel_on_the_right_turns_backwards(world, axis, side, separation, diameter,
                                                   backwards):
    joints = world.spawn(rig(hinge("left", axis), hinge("right", axis))).joints
    left, right = ((joints["left"], Pose((0.0, side, 0.0))),
                   (joints["right"], Pose((0.0, -side, 0.0))))
    parameters = DiffDriveParameters(wheel_separation=separation, wheel_diameter=diameter)
    assert turns_backwards(left, right, parameters) is backwards
