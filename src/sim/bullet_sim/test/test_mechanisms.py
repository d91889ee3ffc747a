"""Lifts, winches, followers, springs and suction cups against closed forms."""

import math

import pytest
from rigs import body, hinge, rig, slider

from bullet_sim.control.pid import Pid, PidGains
from bullet_sim.description import PhysicsDescription, WorldDescription
from bullet_sim.drives.kobuki import WheelDrop
from bullet_sim.errors import SimulationError
from bullet_sim.mechanisms.elevator import Elevator
from bullet_sim.mechanisms.harness import Harness
from bullet_sim.mechanisms.joint_poses import JointPose, JointPoses
from bullet_sim.mechanisms.mimic import MimicJoint, MimicParameters
from bullet_sim.mechanisms.spring_damper import SpringDamper
from bullet_sim.mechanisms.vacuum import Vacuum, VacuumParameters
from bullet_sim.physics.contacts import Contact
from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.twist import Twist
from bullet_sim.world import World

G = 9.8  # m/s^2


@pytest.fixture
def make_world():
    made = []

    def make(gravity: float = 0.0, step: float = 0.001) -> World:
        made.append(World(WorldDescription(gravity=(0.0, 0.0, -gravity),
                                           physics=PhysicsDescription(max_step_size=step))))
        return made[-1]

    yield make
    for world in made:
        world.close()


def run(world: World, seconds: float, update) -> None:
    for _ in range(round(seconds / world.timestep)):
        update()
        world.step()


def run_until(world: World, condition, update, limit: float = 20.0) -> float:
    """Simulated time at which the condition holds."""
    for _ in range(round(limit / world.timestep)):
        if condition():
            return world.time
        update()
        world.step()
    raise AssertionError(f"not within {limit} s")


# --- elevator: gaps close as exp(-t) for the lift and exp(-2 t) for the door

def elevator(world: World):
    lift, door = slider("lift", (0, 0, 1)), slider("door", (1, 0, 0), parent="lift_link")
    joints = world.spawn(rig(lift, door)).joints
    return Elevator(world, joints["lift"], joints["door"], floor_height=2.0, door_wait=0.5), joints


def test_an_elevator_rides_opens_waits_and_closes(make_world):
    world = make_world(gravity=G, step=0.004)
    ride, joints = elevator(world)
    lift, door = joints["lift"], joints["door"]
    assert ride.go(2)
    assert not ride.go(1)  # not before this ride is over
    run(world, 1.0, ride.update)
    assert lift.position == pytest.approx(4.0 * (1 - math.exp(-1.0)), abs=0.03)
    opened = run_until(world, lambda: door.position > 0.02, ride.update)
    assert opened == pytest.approx(math.log(4.0 / 0.15), abs=0.03)
    closing = run_until(world, lambda: door.velocity < -0.5, ride.update)
    assert closing - opened == pytest.approx(math.log(1.0 / 0.05) / 2 + 0.5, abs=0.05)
    closed = run_until(world, lambda: ride.go(0), ride.update)
    assert closed - closing == pytest.approx(math.log(1.0 / 0.05) / 2, abs=0.05)
    assert lift.position == pytest.approx(4.0, abs=0.05)
    run_until(world, lambda: abs(lift.position) < 0.15, ride.update)


def test_a_reset_elevator_takes_another_ride(make_world):
    world = make_world()
    ride, _ = elevator(world)
    assert ride.go(1) and not ride.go(2)
    ride.reset()
    assert ride.go(2)


# --- harness

def test_a_harness_holds_winds_and_lets_fall_for_good(make_world):
    world = make_world(gravity=G)
    link = world.spawn(body("load"), Pose((0.0, 0.0, 1.0))).links["l"]
    winch = Harness(world, link, (0.0, 0.0, 2.0))
    winch.command(0.2)
    run(world, 0.5, winch.update)
    assert link.pose.position == pytest.approx((0.0, 0.0, 1.1), abs=2e-3)
    winch.command(0.0)
    run(world, 0.2, winch.update)
    assert link.pose.position[2] == pytest.approx(1.1, abs=2e-3)
    winch.detach()
    winch.command(0.2)
    run(world, 0.4, winch.update)
    assert link.pose.position[2] == pytest.approx(1.1 - G * 0.4**2 / 2, abs=5e-3)


def test_a_harness_needs_an_axis(make_world):
    world = make_world()
    link = world.spawn(body("load")).links["l"]
    with pytest.raises(SimulationError, match="without axis"):
        Harness(world, link, (0.0, 0.0, 0.0))


# --- joint poses

def test_joint_poses_are_shown_for_their_durations(make_world):
    world = make_world(gravity=G)
    model = world.spawn(rig(hinge("a"), slider("b", (1, 0, 0))))
    player = JointPoses(world)
    player.update()  # nothing to play
    player.play(model, ("a", "elsewhere", "b"),
                [JointPose((0.5, 9.0, 0.1), 0.1), JointPose((-0.5, 9.0, 0.2), 0.2)], start=0.05)
    seen = {}
    for _ in range(350):
        player.update()
        seen[world.tick] = model.joints["a"].position, model.joints["b"].position
        world.step()
    assert seen[45] == pytest.approx((0.0, 0.0))
    assert seen[55] == seen[145] == pytest.approx((0.5, 0.1))
    assert seen[155] == seen[345] == pytest.approx((-0.5, 0.2))


def test_a_player_that_is_stopped_lets_joints_alone(make_world):
    world = make_world()
    model = world.spawn(rig(hinge("a")))
    player = JointPoses(world)
    player.play(model, ("a",), [JointPose((0.5,), 10.0)], start=-1.0)  # that is over: now
    player.update()
    player.stop()
    model.joints["a"].reset(0.1)
    run(world, 0.01, player.update)
    assert model.joints["a"].position == pytest.approx(0.1)


@pytest.mark.parametrize("held, base_yaw, arm_yaw", [(None, 0.3, 0.8), ("a_link", -0.2, 0.3)])
def test_what_is_held_keeps_its_pose_and_the_rest_turns(make_world, held, base_yaw, arm_yaw):
    world = make_world(gravity=G)
    model = world.spawn(rig(hinge("a"), free=True),
                        Pose((1.0, 2.0, 3.0), quaternion_from_rpy(0, 0, 0.3)))
    player = JointPoses(world)
    player.play(model, ("a",), [JointPose((0.5,), 1.0)], 0.0, held and model.links[held])
    run(world, 0.1, player.update)
    player.update()
    assert model.links["base"].pose.rpy()[2] == pytest.approx(base_yaw)
    assert model.links["a_link"].pose.rpy()[2] == pytest.approx(arm_yaw)
    assert model.pose.position == pytest.approx((1.0, 2.0, 3.0))  # both turn about this point
    assert model.twist.linear == (0.0, 0.0, 0.0)  # it does not gather speed meanwhile


# --- mimic

def pair(world: World, parameters: MimicParameters, pid: Pid | None = None, **limits):
    joints = world.spawn(rig(hinge("leader"), hinge("follower", **limits))).joints
    leader, follower = joints["leader"], joints["follower"]
    return leader, follower, MimicJoint(leader, follower, parameters, pid)


def test_a_mimic_joint_follows_multiplier_and_offset(make_world):
    world = make_world()
    leader, follower, mimic = pair(world, MimicParameters(multiplier=-2.0, offset=0.3))
    leader.drive_velocity(1.0, 100.0)
    run(world, 0.2, lambda: mimic.update(world.timestep))
    assert leader.position == pytest.approx(0.2, abs=2e-3)
    assert follower.position == pytest.approx(-2.0 * leader.position + 0.3, abs=5e-3)
    for _ in range(30):  # it neither stops nor jumps on its way
        run(world, world.timestep, lambda: mimic.update(world.timestep))
        assert follower.velocity == pytest.approx(-2.0, abs=1e-2)


def test_a_follower_lets_the_world_come_to_rest(make_world):
    world = make_world()
    _, follower, mimic = pair(world, MimicParameters(offset=0.2))
    world.each_step.append(lambda: mimic.update(world.timestep))
    run_until(world, lambda: world.is_at_rest, lambda: None, limit=2.0)
    assert follower.position == pytest.approx(0.2, abs=1e-4)


def test_a_mimic_joint_stays_within_its_limits(make_world):
    world = make_world()
    leader, follower, mimic = pair(world, MimicParameters(multiplier=3.0), lower=-0.1, upper=0.2)
    leader.reset(1.0)
    run(world, 0.2, lambda: mimic.update(world.timestep))
    assert follower.position == pytest.approx(0.2, abs=1e-3)
    leader.reset(-1.0)
    run(world, 0.2, lambda: mimic.update(world.timestep))
    assert follower.position == pytest.approx(-0.1, abs=1e-3)


@pytest.mark.parametrize("pid", [None, Pid(PidGains(p=10.0))])
@pytest.mark.parametrize("gap, moves", [(0.09, False), (0.11, True)])
def test_a_small_gap_is_left_alone(make_world, pid, gap, moves):
    world = make_world()
    leader, follower, mimic = pair(world, MimicParameters(sensitiveness=0.1), pid)
    leader.reset(gap)
    run(world, 0.01, lambda: mimic.update(world.timestep))
    assert (follower.position > 1e-5) is moves


def test_a_mimic_joint_with_a_pid_is_pushed_with_its_greatest_effort(make_world):
    world = make_world()
    parameters = MimicParameters(offset=1.0, max_effort=0.5)
    _, follower, mimic = pair(world, parameters, Pid(PidGains(p=1000.0)))
    run(world, 0.1, lambda: mimic.update(world.timestep))
    assert follower.velocity == pytest.approx(0.5 / 0.01 * 0.1, rel=1e-3)  # effort / inertia * t


def test_a_reset_mimic_joint_forgets_what_it_has_integrated(make_world):
    pid = Pid(PidGains(i=1.0, i_clamp_max=100.0, i_clamp_min=-100.0))
    world = make_world()
    _, _, mimic = pair(world, MimicParameters(offset=1.0), pid)
    run(world, 0.1, lambda: mimic.update(world.timestep))
    assert pid.error_integral == pytest.approx(0.1, rel=0.01)
    mimic.reset()
    assert pid.error_integral == 0.0
    pair(make_world(), MimicParameters())[2].reset()  # without a PID there is nothing to forget


# --- spring and damper: critically damped, x(t) = x(0) (1 + w t) exp(-w t)

def test_a_spring_pulls_a_link_as_critically_damped(make_world):
    world = make_world(gravity=G)
    link = world.spawn(body("a")).links["l"]
    spring = SpringDamper(world, link, stiffness=25.0, angular_stiffness=0.25)  # w = 5 rad/s both
    wanted = Pose((0.4, 0.0, 0.2), quaternion_from_rpy(0, 0, 0.5))
    run(world, 0.4, lambda: spring.update(wanted))
    left = (1 + 2.0) * math.exp(-2.0)
    assert link.pose.position == pytest.approx((0.4 * (1 - left), 0.0, 0.2 * (1 - left)), abs=3e-3)
    assert link.pose.rpy()[2] == pytest.approx(0.5 * (1 - left), abs=3e-3)


def test_without_a_wanted_pose_a_link_only_floats_on(make_world):
    world = make_world(gravity=G)
    model = world.spawn(body("a"))
    spring = SpringDamper(world, model.links["l"])
    model.set_velocity(Twist((0.1, 0.0, 0.0)))
    run(world, 0.5, lambda: spring.update(None))
    assert model.pose.position == pytest.approx((0.05, 0.0, 0.0), abs=1e-3)


# --- vacuum

def suction(world: World, distance: float, static: bool = False):
    cup = world.spawn(body("gripper"))
    thing = world.spawn(body("thing", static=static), Pose((distance, 0.0, 0.0)))
    cup.set_velocity(Twist((0.0, 0.3, 0.0)))
    return Vacuum(world, cup.links["l"], VacuumParameters()), thing


def test_what_is_near_is_carried_along_and_pulled_to_the_cup(make_world):
    world = make_world()
    vacuum, thing = suction(world, 0.04)
    assert vacuum.update()
    assert thing.twist.linear == pytest.approx((0.0, 0.3, 0.0))
    world.step()
    # 1 / 0.04 N is more than the greatest force, 20 N; the thing has 1 kg
    assert thing.twist.linear == pytest.approx((-20.0 * 0.001, 0.3, 0.0))


def test_the_pull_is_the_distances_inverse_where_that_is_less(make_world):
    world = make_world()
    cup, thing = world.spawn(body("gripper")), world.spawn(body("thing"), Pose((0.0, 0.0, -0.25)))
    assert Vacuum(world, cup.links["l"], VacuumParameters(max_distance=0.3)).update()
    world.step()
    assert thing.twist.linear == pytest.approx((0.0, 0.0, 4.0 * 0.001))


def test_what_is_very_near_is_put_into_the_cup(make_world):
    world = make_world()
    vacuum, thing = suction(world, 0.009)
    assert vacuum.update()
    assert thing.pose.position == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize("distance, static", [(0.051, False), (0.02, True)])
def test_what_is_far_or_static_is_left_where_it_is(make_world, distance, static):
    world = make_world()
    vacuum, thing = suction(world, distance, static)
    assert not vacuum.update()
    assert thing.pose.position == (distance, 0.0, 0.0)
    assert thing.twist.linear == (0.0, 0.0, 0.0)


# --- wheel drop

def on_ground(link: str) -> Contact:
    return Contact("floor::l::c", f"{link}::c", (0, 0, 0), (0, 0, -1), 0.0, (0, 0, -1))


def test_a_wheel_has_dropped_when_it_touched_nothing_for_a_while():
    wheels = WheelDrop({"left": "bot::left", "right": "bot::right"}, time=1.0)
    left, right = on_ground("bot::left"), on_ground("bot::right")
    assert wheels.dropped([left, right], 2.0) == set()
    assert wheels.dropped([right], 2.09) == set()  # it only hops
    assert wheels.dropped([right], 2.11) == {"left"}
    assert wheels.dropped([left, left.reversed()], 2.15) == set()
    assert wheels.dropped([left.reversed()], 2.25) == {"right"}


def test_a_wheel_has_not_dropped_when_time_was_reset():
    wheels = WheelDrop({"left": "bot::left"}, time=9.0)
    assert wheels.dropped([], 0.5) == set()
    assert wheels.dropped([], 0.61) == {"left"}
