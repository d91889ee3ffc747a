"""Drives of a base: limits, odometry and wheel commands against closed forms."""

import math

import pytest

from bullet_sim.control.controllers.ackermann_steering_controller import (
    AckermannGeometry,
    AckermannSteering,
)
from bullet_sim.control.controllers.commands import TimedCommand
from bullet_sim.control.controllers.diff_drive_controller import DiffDriveGeometry, DiffDriveLaw
from bullet_sim.control.controllers.four_wheel_steering_controller import (
    FourWheelGeometry,
    FourWheelSteering,
    measured_twist,
    wheel_commands,
)
from bullet_sim.control.controllers.mobile_base import (
    BaseOptions,
    PlanarOdometry,
    SpeedLimiter,
    SpeedLimits,
)
from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.errors import SimulationError
from bullet_sim.sensors.odometry import WheelOdometry

STEP = 0.001  # s


def handle(name: str, interface: str = "velocity") -> CommandHandle:
    return CommandHandle(JointHandle(name, "continuous"), interface)


def turn(*handles: CommandHandle, step: float = STEP) -> None:
    """Let joints do what they are told."""
    for made in handles:
        if made.interface == "position":
            made.joint.position = made.command
        else:
            made.joint.velocity = made.command
            made.joint.position += made.command * step


def drive(base, handles, seconds: float, command=None, start: float = 0.0, each=None) -> float:
    """Update at 1 kHz, commanding all the time; returns when it ended."""
    time = start
    for _ in range(round(seconds / STEP)):
        time += STEP
        if command:
            base.command(time, *command)
        base.update(time, STEP)
        turn(*handles)
        if each:
            each()
    return time


# --- limits

def test_velocity_is_bounded_on_both_sides():
    limiter = SpeedLimiter(SpeedLimits(velocity=(-0.5, 1.0)))
    assert limiter.limit(3.0, STEP) == 1.0
    assert limiter.limit(-3.0, STEP) == -0.5
    assert limiter.limit(0.2, STEP) == 0.2


def test_acceleration_makes_a_ramp():
    limiter = SpeedLimiter(SpeedLimits(acceleration=(-4.0, 2.0)))
    speeds = [limiter.limit(10.0, 0.1) for _ in range(3)]
    assert speeds == pytest.approx([0.2, 0.4, 0.6])
    assert limiter.limit(0.0, 0.1) == pytest.approx(0.2)  # braking is harder here


def test_jerk_makes_a_parabola():
    limiter = SpeedLimiter(SpeedLimits(jerk=(-5.0, 5.0)))
    speeds = [limiter.limit(10.0, 0.1) for _ in range(4)]
    # Each step's change grows by 2 j t^2 = 0.1, as upstream counts it.
    assert speeds == pytest.approx([0.1, 0.3, 0.6, 1.0])


def test_all_limits_together_and_a_fresh_start():
    limiter = SpeedLimiter(SpeedLimits((-1.0, 1.0), (-2.0, 2.0), (-5.0, 5.0)))
    speeds = [limiter.limit(10.0, 0.1) for _ in range(20)]
    assert speeds[:4] == pytest.approx([0.1, 0.3, 0.5, 0.7])
    assert speeds[-1] == 1.0
    limiter.restart()
    assert limiter.limit(10.0, 0.1) == pytest.approx(0.1)


def test_a_command_is_good_for_its_time_only():
    command = TimedCommand(2, timeout=0.5)
    assert command.at(0.0) == (0.0, 0.0)
    command.give(10.0, 1.0, 2.0)
    assert command.at(10.5) == (1.0, 2.0)
    assert command.at(10.501) == (0.0, 0.0)
    assert command.at(9.0) == (0.0, 0.0)  # time was reset since


# --- odometry

def test_a_full_circle_ends_where_it_began():
    odometry, steps = PlanarOdometry(10), 7
    for step in range(1, steps + 1):
        odometry.move(float(step), 3.0 / steps, 0.0, 2 * math.pi / steps)
    x, y, _ = odometry.sample().pose.position
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize("signed, forward", [(False, 0.2), (True, -0.2)])
def test_gazebos_odometry_of_wheels_knows_no_way_back_unless_signed(signed, forward):
    """gazebo_ros_diff_drive tells the length of the way: it is positive backwards, too."""
    counted = WheelOdometry(wheel_separation=0.5, wheel_diameter=0.2, signed=signed)
    counted.update(0.05, -2.5, -1.5)
    reading = counted.sample()
    assert (reading.forward, reading.yaw_rate) == pytest.approx((forward, 0.2))
    assert reading.pose.position[0] == pytest.approx(-0.2 * 0.05, rel=1e-3)


def test_a_quarter_of_an_arc_is_exact_in_one_step():
    odometry, radius = PlanarOdometry(1), 2.0
    odometry.move(1.0, radius * math.pi / 2, 0.0, math.pi / 2)
    reading = odometry.sample()
    assert reading.pose.position[:2] == pytest.approx((radius, radius))
    assert reading.pose.rpy()[2] == pytest.approx(math.pi / 2)
    assert (reading.forward, reading.yaw_rate) == pytest.approx((math.pi, math.pi / 2))


def test_speeds_are_means_over_the_window():
    odometry = PlanarOdometry(4)
    for step, way in enumerate((1.0, 2.0, 3.0, 4.0, 5.0), 1):
        odometry.move(float(step), way, 0.0, 0.0)
    assert odometry.sample().forward == pytest.approx((2 + 3 + 4 + 5) / 4)


def test_a_reset_of_time_is_no_way():
    odometry = PlanarOdometry(2)
    odometry.move(5.0, 1.0, 0.0, 0.0)
    odometry.move(0.0, -100.0, 0.0, 0.0)
    odometry.move(1.0, 0.5, 0.0, 0.0)
    assert odometry.sample().pose.position[0] == pytest.approx(1.5)
    assert odometry.sample().forward == pytest.approx(0.5)


# --- differential drive

def diff_drive(options: BaseOptions = BaseOptions(), right_radius: float = 0.05):
    left, right = [handle("l1"), handle("l2")], [handle("r1"), handle("r2")]
    base = DiffDriveLaw(left, right, DiffDriveGeometry(0.3, 0.05, right_radius), options)
    for made in (*left, *right):
        made.joint.position = 7.0  # the wheels have turned before
    base.start(0.0)
    return base, (*left, *right)


def test_diff_drive_turns_its_wheels_and_counts_them():
    base, wheels = diff_drive()
    drive(base, wheels, 2.0, (0.5, 1.0))
    assert [wheel.command for wheel in wheels] == pytest.approx([7.0, 7.0, 13.0, 13.0])
    drive(base, wheels, STEP, start=2.0)
    reading = base.odometry.sample()
    assert reading.pose.rpy()[2] == pytest.approx(2.0)
    assert reading.pose.position[:2] == pytest.approx(
        (0.5 * math.sin(2.0), 0.5 * (1 - math.cos(2.0))))
    assert (reading.forward, reading.yaw_rate) == pytest.approx((0.5, 1.0))


def test_diff_drive_with_a_larger_right_wheel_still_goes_straight():
    base, wheels = diff_drive(right_radius=0.06)
    drive(base, wheels, 1.0, (0.6, 0.0))
    assert wheels[0].command == pytest.approx(12.0)
    assert wheels[2].command == pytest.approx(10.0)
    assert base.odometry.sample().yaw_rate == pytest.approx(0.0, abs=1e-9)


def test_diff_drive_brakes_within_its_limits_when_commands_end():
    limits = SpeedLimits(acceleration=(-2.0, 2.0))
    base, wheels = diff_drive(BaseOptions(forward_limits=limits, command_timeout=0.5))
    base.command(0.0, 1.0, 0.0)
    drive(base, wheels, 0.25)
    assert base.limited[0] == pytest.approx(0.5)
    drive(base, wheels, 0.25, start=0.25)
    assert base.limited[0] == pytest.approx(1.0, abs=0.01)
    drive(base, wheels, 0.25, start=0.5)
    assert base.limited[0] == pytest.approx(0.5, abs=0.01)
    base.start(0.75)
    assert all(wheel.command == 0.0 for wheel in wheels)
    assert base.odometry.sample().pose.position[0] > 0.4  # a restart forgets no way


def test_open_loop_believes_the_command():
    base, _ = diff_drive(BaseOptions(open_loop=True))
    drive(base, (), 1.0, (0.5, 0.0))  # the wheels do not turn at all
    assert base.odometry.sample().pose.position[0] == pytest.approx(0.5, rel=0.01)
    reading = base.odometry.sample()
    assert (reading.forward, reading.leftward, reading.yaw_rate) == (0.5, 0.0, 0.0)


# --- Ackermann steering

def test_ackermann_writes_the_angle_and_drives_its_circle():
    rear, front = handle("rear"), handle("front", "position")
    base = AckermannSteering(rear, front, AckermannGeometry(0.335, 0.05), BaseOptions())
    base.start(0.0)
    drive(base, (rear, front), 1.0, (1.0, 0.3))
    assert (rear.command, front.command) == pytest.approx((20.0, 0.3))
    reading = base.odometry.sample()
    assert reading.forward / reading.yaw_rate == pytest.approx(0.335 / math.tan(0.3))


def test_ackermann_measures_a_steering_joint_through_its_gear():
    rear, front = handle("rear"), handle("front", "position")
    base = AckermannSteering(rear, front, AckermannGeometry(0.335, 0.05, steering_multiplier=2.0),
                             BaseOptions())
    base.start(0.0)
    drive(base, (rear, front), 1.0, (1.0, 0.2))
    reading = base.odometry.sample()
    assert reading.forward / reading.yaw_rate == pytest.approx(0.335 / math.tan(0.4))


def test_ackermann_open_loop_turns_the_angle_into_a_rate_of_yaw():
    rear, front = handle("rear"), handle("front", "position")
    base = AckermannSteering(rear, front, AckermannGeometry(0.335, 0.05),
                             BaseOptions(open_loop=True))
    base.start(0.0)
    drive(base, (), 0.1, (1.0, 0.3))
    assert base.odometry.sample().yaw_rate == pytest.approx(math.tan(0.3) / 0.335)


# --- four wheels

GEOMETRY = FourWheelGeometry(track=0.6, wheelbase=0.8, wheel_radius=0.1)


@pytest.mark.parametrize("front, rear", [
    (0.4, -0.4), (0.3, 0.0), (0.2, 0.2), (-0.5, 0.1), (1.0, -1.0)])
@pytest.mark.parametrize("forward", [1.0, -0.7])
def test_no_wheel_scrubs(front, rear, forward):
    """Each wheel rolls as the rigid body moves at its place."""
    yaw_rate = forward * (front - rear) / GEOMETRY.wheelbase
    leftward = forward * (front + rear) / 2
    for (x, y), (speed, angle) in zip(
            GEOMETRY.places(), wheel_commands(GEOMETRY, forward, front, rear), strict=True):
        rim = speed * GEOMETRY.wheel_radius
        assert rim * math.cos(angle) == pytest.approx(forward - yaw_rate * y)
        assert rim * math.sin(angle) == pytest.approx(leftward + yaw_rate * x)


def test_what_four_wheels_say_is_the_twist_they_were_told():
    commands = wheel_commands(GEOMETRY, 0.9, 0.35, -0.1)
    speeds = [speed * GEOMETRY.wheel_radius for speed, _ in commands]
    twist = measured_twist(GEOMETRY, speeds, [angle for _, angle in commands])
    assert twist == pytest.approx((0.9, 0.9 * 0.125, 0.9 * 0.45 / 0.8))


def test_a_turning_point_between_the_wheels_is_a_right_angle_for_all():
    angles = [angle for _, angle in wheel_commands(GEOMETRY, 0.1, 4.0, -4.0)]
    assert angles == pytest.approx([math.pi / 2] * 2 + [-math.pi / 2] * 2)


def four_wheels():
    wheels = [handle(f"wheel{i}") for i in range(4)]
    steering = [handle(f"steering{i}", "position") for i in range(4)]
    base = FourWheelSteering(wheels, steering, GEOMETRY, BaseOptions())
    base.start(0.0)
    return base, wheels, steering


def test_four_wheel_twist_is_driven_and_measured():
    base, wheels, steering = four_wheels()
    drive(base, (*wheels, *steering), 1.0, (0.5, 0.4))
    reading = base.odometry.sample()
    assert (reading.forward, reading.leftward, reading.yaw_rate) == pytest.approx(
        (0.5, 0.0, 0.4), abs=1e-9)


def test_the_later_of_twist_and_axle_angles_holds():
    base, wheels, steering = four_wheels()
    base.command(0.0, 0.5, 0.4)
    base.command_axles(0.1, 0.5, 0.2, 0.2)
    drive(base, (*wheels, *steering), 0.2, start=0.1)
    assert [made.command for made in steering] == pytest.approx([0.2] * 4)  # crab-wise
    reading = base.odometry.sample()
    assert reading.leftward / reading.forward == pytest.approx(math.tan(0.2))
    base.command(0.3, 0.5, 0.0)
    drive(base, (*wheels, *steering), 0.1, start=0.3)
    assert [made.command for made in steering] == pytest.approx([0.0] * 4)


def test_four_wheels_stand_straight_after_the_time_out():
    base, wheels, steering = four_wheels()
    base.command_axles(0.0, 1.0, 0.3, -0.3)
    drive(base, (*wheels, *steering), 0.6)
    assert [made.command for made in (*wheels, *steering)] == [0.0] * 8


@pytest.mark.parametrize("made", [
    lambda: DiffDriveGeometry(0.0, 0.1, 0.1), lambda: AckermannGeometry(0.3, -0.1),
    lambda: FourWheelGeometry(0.1, float("nan"), 0.1)])
def test_impossible_geometry_is_an_error_with_its_number(made):
    with pytest.raises(SimulationError, match=r"must be above 0"):
        made()
