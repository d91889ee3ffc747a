"""Mecanum wheels and a car as a bicycle, against their published kinematics."""

import math

import pytest
from rigs import hinge, rig

from bullet_sim.control.controllers.mecanum_drive_controller import MecanumDrive, MecanumGeometry
from bullet_sim.control.controllers.mobile_base import BaseOptions, SpeedLimits
from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.steer_bot import SteerBotGeometry, SteerBotHardware
from bullet_sim.description import JointLimits, WorldDescription
from bullet_sim.errors import SimulationError
from bullet_sim.world import World

STEP = 0.001  # s

# --- mecanum drive: wheel rate = (vx -+ vy -+ (lx + ly) w) / r

REACH, RADIUS = 0.4, 0.05  # m


def mecanum(options: BaseOptions = BaseOptions(), **limits):
    wheels = [CommandHandle(JointHandle(name, "continuous"), "velocity")
              for name in ("front_left", "back_left", "back_right", "front_right")]
    for wheel in wheels:
        wheel.joint.position = 3.0  # they have turned before
    base = MecanumDrive(wheels, MecanumGeometry(REACH, RADIUS), options, **limits)
    base.start(0.0)
    return base, wheels


def drive(base, wheels, seconds: float, command) -> None:
    for step in range(1, round(seconds / STEP) + 1):
        base.command(step * STEP, *command)
        base.update(step * STEP, STEP)
        for wheel in wheels:
            wheel.joint.position += wheel.command * STEP
    base.update(seconds + STEP, STEP)  # count the last step


@pytest.mark.parametrize("forward, turning, leftward, rims", [
    (0.5, 0.0, 0.0, (0.5, 0.5, 0.5, 0.5)), (0.0, 0.0, 0.5, (-0.5, 0.5, -0.5, 0.5)),
    (0.0, 1.0, 0.0, (-0.4, -0.4, 0.4, 0.4)), (0.3, 0.5, 0.1, (0.0, 0.2, 0.4, 0.6))])
def test_mecanum_wheels_turn_by_the_inverse_kinematics(forward, turning, leftward, rims):
    base, wheels = mecanum()
    base.command(1.0, forward, turning, leftward)
    base.update(1.0, STEP)
    assert [wheel.command * RADIUS for wheel in wheels] == pytest.approx(rims)


@pytest.mark.parametrize("command, way", [
    ((0.5, 0.0, 0.0), (0.5, 0.0, 0.0)), ((0.0, 0.0, -0.5), (0.0, -0.5, 0.0)),
    ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), ((0.4, 0.0, 0.3), (0.4, 0.3, 0.0))])
def test_mecanum_odometry_is_what_was_commanded(command, way):
    base, wheels = mecanum()
    drive(base, wheels, 1.0, command)
    reading = base.odometry.sample()
    x, y, _ = reading.pose.position
    assert (x, y, reading.pose.rpy()[2]) == pytest.approx(way)
    assert (reading.forward, reading.leftward, reading.yaw_rate) == pytest.approx(way)


def test_mecanum_odometry_knows_no_open_loop():
    base, _ = mecanum(BaseOptions(open_loop=True))
    base.command(STEP, 1.0, 0.0)
    base.update(STEP, STEP)
    base.update(2 * STEP, STEP)  # but the wheels are blocked
    assert base.odometry.sample().pose.position[0] == 0.0


def test_a_leftward_command_has_limits_and_a_time():
    base, wheels = mecanum(BaseOptions(command_timeout=0.5),
                           sideways_limits=SpeedLimits(velocity=(-0.2, 0.1)))
    base.command(1.0, 0.0, 0.0, 9.0)
    base.update(1.0, STEP)
    assert wheels[1].command == pytest.approx(0.1 / RADIUS)
    base.update(1.51, STEP)
    assert wheels[1].command == 0.0


@pytest.mark.parametrize("brake", ["stop", "start"])
def test_mecanum_wheels_brake_at_once(brake):
    base, wheels = mecanum()
    base.command(1.0, 0.3, 0.2, 0.1)
    base.update(1.0, STEP)
    assert all(wheel.command for wheel in wheels)
    base.stop() if brake == "stop" else base.start(1.0)
    assert [wheel.command for wheel in wheels] == [0.0] * 4
    base.update(1.0 + STEP, STEP)
    assert (wheels[1].command == 0.0) is (brake == "start")  # start forgets the command, too


@pytest.mark.parametrize("geometry", [MecanumGeometry, SteerBotGeometry])
@pytest.mark.parametrize("lengths", [(0.0, 0.1), (0.1, -1.0)])
def test_a_geometry_has_lengths(geometry, lengths):
    with pytest.raises(SimulationError, match="it must be above 0"):
        geometry(*lengths)


# --- a car as a bicycle: all wheels turn about one point, R = h / tan(middle) to the left

CAR = SteerBotGeometry(track=0.2, wheelbase=0.3)


@pytest.mark.parametrize("middle", [0.4, -0.4, 0.01])
def test_steered_wheels_point_at_right_angles_to_the_turns_centre(middle):
    radius = CAR.wheelbase / math.tan(middle)
    right, left = CAR.angles(middle)
    assert math.tan(right) == pytest.approx(CAR.wheelbase / (radius + 0.1))
    assert math.tan(left) == pytest.approx(CAR.wheelbase / (radius - 0.1))
    assert CAR.shares(middle) == pytest.approx(((radius + 0.1) / radius, (radius - 0.1) / radius))
    assert CAR.middle(right, left) == pytest.approx(middle)


def test_without_ackermann_wheels_are_parallel_and_equally_fast():
    parallel = SteerBotGeometry(track=0.2, wheelbase=0.3, ackermann=False)
    assert parallel.angles(0.4) == (0.4, 0.4)
    assert parallel.shares(0.4) == (1.0, 1.0)
    assert parallel.middle(0.3, 0.5) == pytest.approx(0.4)


@pytest.fixture(params=[{}])
def hardware(request):
    """`request.param`: limits by joint."""
    limits = {name: JointLimits(**options) for name, options in request.param.items()}
    world = World(WorldDescription(gravity=(0.0, 0.0, 0.0)))
    rear = [hinge(name, (0, 1, 0)) for name in ("right_wheel", "left_wheel")]
    front = [hinge(name) for name in ("right_steer", "left_steer")]
    model = world.spawn(rig(*rear, *front))
    yield world, model, SteerBotHardware(
        model, "rear_wheel", "front_steer", ["right_wheel", "left_wheel"],
        ["right_steer", "left_steer"], CAR, limits)
    world.close()


def act(world: World, hardware: SteerBotHardware, rate: float, angle: float, steps: int) -> None:
    hardware.command_handle("velocity", "rear_wheel").command = rate
    hardware.command_handle("position", "front_steer").command = angle
    for _ in range(steps):
        hardware.read()
        hardware.write(STEP)
        world.step()
    hardware.read()


def test_virtual_joints_move_the_real_ones_and_are_their_means(hardware):
    world, model, hardware = hardware
    act(world, hardware, 5.0, 0.4, 100)
    radius = CAR.wheelbase / math.tan(0.4)
    joints = model.joints
    assert joints["right_wheel"].velocity == pytest.approx(5.0 * (radius + 0.1) / radius, rel=1e-3)
    assert joints["left_wheel"].velocity == pytest.approx(5.0 * (radius - 0.1) / radius, rel=1e-3)
    assert joints["left_steer"].position == pytest.approx(math.atan(0.3 / (radius - 0.1)), abs=1e-4)
    wheel, steer = (hardware.joint_handle(name) for name in ("rear_wheel", "front_steer"))
    assert (wheel.position, wheel.velocity) == pytest.approx((0.5, 5.0), rel=5e-3)
    assert (steer.position, steer.velocity) == pytest.approx((0.4, 0.0), abs=1e-3)


def test_beyond_the_steepest_angle_the_wheels_still_have_one(hardware):
    world, model, hardware = hardware
    act(world, hardware, 0.0, 2.0, 2)
    angles = [model.joints[name].position for name in ("right_steer", "left_steer")]
    assert angles == pytest.approx(CAR.angles(math.radians(89.0)), abs=1e-3)


@pytest.mark.parametrize("hardware", [{"left_wheel": {"acceleration": 10.0}}], indirect=True)
def test_after_a_reset_a_ramp_begins_anew(hardware):
    world, model, hardware = hardware
    act(world, hardware, 5.0, 0.0, 100)
    assert model.joints["left_wheel"].motor[0] == pytest.approx(1.0)  # 10 rad/s^2 for 0.1 s
    model.reset()
    hardware.reset()
    act(world, hardware, 5.0, 0.0, 1)
    assert model.joints["left_wheel"].motor[0] == pytest.approx(0.01)
