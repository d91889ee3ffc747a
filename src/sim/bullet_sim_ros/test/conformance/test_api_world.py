"""Time, pause, reset and physics of /gazebo, and its parameters."""

import math

import pytest
import rospy
from gazebo_msgs.msg import ODEPhysics
from geometry_msgs.msg import Vector3

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist
from bullet_sim_ros import loop
from bullet_sim_ros.params import read_node_parameters

ARM = """<model name="arm"><link name="base"/><link name="tip"/>
  <joint name="root" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="hinge" type="revolute"><parent>base</parent><child>tip</child>
    <axis><xyz>0 0 1</xyz></axis></joint></model>"""
GROUND_1000 = """<sdf version="1.6"><world name="default"><physics type="ode">
  <real_time_update_rate>1000</real_time_update_rate></physics></world></sdf>"""
BOX = """<model name="box"><link name="body"><gravity>false</gravity></link>
  <plugin name="truth" filename="libgazebo_ros_p3d.so"><bodyName>body</bodyName>
    <topicName>truth</topicName><updateRate>100</updateRate>
    <gaussianNoise>0.1</gaussianNoise></plugin></model>"""
WHEEL = """<link name="{0}"><pose>0 {1} 0.1 -1.5708 0 0</pose><collision name="c"><geometry><sphere>
  <radius>0.1</radius></sphere></geometry></collision></link><joint name="{0}_joint"
  type="revolute"><parent>base</parent><child>{0}</child><axis><xyz>0 0 1</xyz></axis></joint>"""
CAR = f"""<model name="car"><link name="base"><pose>0 0 0.1 0 0 0</pose></link>
  {WHEEL.format("left", 0.2)}{WHEEL.format("right", -0.2)}
  <plugin name="drive" filename="libgazebo_ros_diff_drive.so"><leftJoint>left_joint</leftJoint>
    <rightJoint>right_joint</rightJoint><wheelSeparation>0.4</wheelSeparation>
    <wheelDiameter>0.2</wheelDiameter></plugin></model>"""


def near(*values):
    return pytest.approx(values, abs=1e-6)


def stamps(messages):
    return [message.header.stamp.to_sec() for message in messages]


# --- time

def test_the_clock_at_its_rate(make_bench):
    # conforms: /clock, ~pub_clock_frequency
    bench = make_bench(pub_clock_frequency=50.0)
    clock = bench.listen("/clock")
    bench.run(0.1)
    assert [round(message.clock.to_sec(), 6) for message in clock] == [
        0.0, 0.02, 0.04, 0.06, 0.08, 0.1]
    assert bench.graph.topics["/clock"].publishers[0].options.get("latch", False) is False


def test_the_clock_at_every_step(make_bench):
    # conforms: ~pub_clock_frequency
    bench = make_bench(pub_clock_frequency=0.0)
    clock = bench.listen("/clock")
    bench.run(0.02)
    assert len(clock) == 1 + 20


def test_parameters_of_the_node(graph):
    # conforms: ~pub_clock_frequency, ~enable_ros_network, /use_sim_time, ~pub_state_frequency
    assert read_node_parameters().pub_clock_frequency == 100.0
    assert graph.parameters["/use_sim_time"] is True
    graph.parameters.update({
        "/use_sim_time": False, "/gazebo/pub_clock_frequency": -1,
        "/gazebo/enable_ros_network": False, "/gazebo/pub_state_frequency": 25})
    told = read_node_parameters()
    assert (told.pub_clock_frequency, told.pub_state_frequency) == (0.0, 25.0)
    assert told.enable_ros_network is False and graph.parameters["/use_sim_time"] is False


def test_without_a_ros_network_there_is_only_the_clock(make_bench):
    # conforms: ~enable_ros_network
    bench = make_bench(enable_ros_network=False)
    assert "/clock" in bench.advertised()
    assert not {"/gazebo/model_states", "/gazebo/link_states"} & set(bench.advertised())
    assert "/gazebo/set_model_state" not in bench.subscribed()


def test_pause_stops_everything_but_services(bench):
    # conforms: /gazebo/pause_physics, /gazebo/unpause_physics
    bench.spawn(BOX)
    clock, truth = bench.listen("/clock"), bench.listen("/truth")
    bench.run(0.1)
    bench.call("/gazebo/pause_physics")
    count = len(clock), len(truth)
    bench.simulation.mailbox.post(bench.simulation.stop)
    loop.run(bench.simulation)
    clock.pop()  # that with which every run begins
    assert (len(clock), len(truth)) == count
    assert bench.call("/gazebo/get_world_properties").sim_time == pytest.approx(0.1)
    assert bench.call("/gazebo/get_physics_properties").pause is True
    bench.simulation._stop_requested = False
    bench.call("/gazebo/unpause_physics")
    bench.run(0.1)
    assert len(truth) == 20


def test_a_step_is_one_step_and_time_stands_again(bench):
    # conforms: /gazebo/step_physics
    bench.spawn(BOX)
    clock, truth = bench.listen("/clock"), bench.listen("/truth")
    bench.run(0.1)
    bench.call("/gazebo/pause_physics")
    count = len(truth)
    for _ in range(10):
        bench.call("/gazebo/step_physics")
    assert bench.call("/gazebo/get_world_properties").sim_time == pytest.approx(0.11)
    assert bench.call("/gazebo/get_physics_properties").pause is True
    assert len(truth) == count + 1  # at 100 Hz
    assert clock[-1].clock.to_sec() == pytest.approx(0.11)


# --- reset

def test_reset_world_puts_models_back_and_leaves_time_alone(bench):
    # conforms: /gazebo/reset_world
    box, arm = bench.spawn(BOX, Pose((1, 0, 3))), bench.spawn(ARM)
    bench.run(0.1)
    arm.joint("hinge").reset(0.5, 1.0)
    box.set_pose(Pose((9, 9, 9)))  # not where it is put back to
    box.set_twist(Twist((1, 0, 0), (0, 0, 1)))
    for paused in (False, True):
        bench.world.paused = paused
        bench.call("/gazebo/reset_world")
        assert bench.world.paused is paused
        assert box.pose.position == near(1, 0, 3) and box.twist == Twist()
        assert (arm.joint("hinge").position, arm.joint("hinge").velocity) == (0, 0)
        assert bench.world.time == pytest.approx(0.1)


def test_reset_simulation_sets_the_clock_back(bench):
    # conforms: /gazebo/reset_simulation, /clock
    box = bench.spawn(BOX, Pose((1, 0, 3)))
    bench.run(0.5)
    box.set_pose(Pose((9, 9, 9)))
    clock, truth = bench.listen("/clock"), bench.listen("/truth")
    bench.call("/gazebo/reset_simulation")
    assert clock[-1].clock == rospy.Time(0) and bench.world.time == 0.0
    assert box.pose.position == near(1, 0, 3)
    bench.run(0.05)
    assert stamps(truth) == near(0.01, 0.02, 0.03, 0.04, 0.05)
    assert bench.world.paused is False


def test_noise_is_the_same_after_a_reset(bench):
    # conforms: /gazebo/reset_simulation
    bench.spawn(BOX)
    truth = bench.listen("/truth")
    bench.run(0.1)
    bench.call("/gazebo/reset_simulation")
    bench.run(0.1)
    seen = [message.twist.twist.linear.x for message in truth]
    assert len(seen) == 20 and seen[:10] == seen[10:] and len(set(seen)) == 10


def test_after_a_reset_odometry_begins_again_at_once(bench):
    # conforms: /gazebo/reset_simulation
    bench.spawn(CAR)
    transforms, odometry = bench.listen("/tf"), bench.listen("/car/odom")
    bench.run(0.3)
    bench.call("/gazebo/reset_simulation")
    for messages in (transforms, odometry):
        messages.clear()
    bench.run(0.05)
    assert stamps(odometry) == near(0.01, 0.02, 0.03, 0.04, 0.05)
    found = [transform for message in transforms for transform in message.transforms
             if transform.header.frame_id == "odom"]
    assert stamps(found) == near(0.01, 0.02, 0.03, 0.04, 0.05)


# --- physics

def ode(**changes):
    values = dict(auto_disable_bodies=True, sor_pgs_precon_iters=1, sor_pgs_iters=60,
                  sor_pgs_w=1.1, contact_surface_layer=0.002, contact_max_correcting_vel=50.0,
                  cfm=0.01, erp=0.3, max_contacts=7)
    return ODEPhysics(**{**values, **changes})


def set_physics(bench, **fields):
    values = dict(time_step=0.002, max_update_rate=250.0, gravity=Vector3(0, 0, -1.6),
                  ode_config=ode())
    return bench.call("/gazebo/set_physics_properties", **{**values, **fields})


def test_physics_as_the_world_has_them(make_bench):
    # conforms: /gazebo/get_physics_properties, /gazebo/get_physics_properties/time_step
    # conforms: /gazebo/get_physics_properties/pause, /gazebo/get_physics_properties/gravity
    # conforms: /gazebo/get_physics_properties/max_update_rate
    # conforms: /gazebo/get_physics_properties/ode_config
    # conforms: /gazebo/get_physics_properties/success
    # conforms: /gazebo/get_physics_properties/status_message
    bench = make_bench(GROUND_1000)
    bench.world.paused = True
    answer = bench.call("/gazebo/get_physics_properties")
    assert (answer.time_step, answer.pause, answer.max_update_rate) == (0.001, True, 1000.0)
    assert answer.gravity == Vector3(0, 0, -9.8)
    config = answer.ode_config
    assert (config.sor_pgs_iters, config.sor_pgs_w, config.erp, config.max_contacts) == (
        50, 1.3, 0.2, 20)
    assert config.sor_pgs_rms_error_tol == 0.0 and config.auto_disable_bodies is False
    assert (answer.success, answer.status_message) == (
        True, "GetPhysicsProperties: got properties")


def test_physics_are_changed_all_at_once(bench):
    # conforms: /gazebo/set_physics_properties, /gazebo/set_physics_properties/time_step
    # conforms: /gazebo/set_physics_properties/max_update_rate
    # conforms: /gazebo/set_physics_properties/gravity
    # conforms: /gazebo/set_physics_properties/ode_config
    # conforms: /gazebo/set_physics_properties/success
    # conforms: /gazebo/set_physics_properties/status_message
    answer = set_physics(bench)
    assert (answer.success, answer.status_message) == (True, "physics engine updated")
    told = bench.call("/gazebo/get_physics_properties")
    assert (told.time_step, told.max_update_rate, told.pause) == (0.002, 250.0, False)
    assert told.ode_config == ode()
    assert bench.simulation.pacer.factor == pytest.approx(0.5)  # 250 steps of 2 ms a second
    falling = bench.spawn(ARM.replace("world", "tip").replace('<joint name="root" type="fixed">'
                          "<parent>tip</parent><child>base</child></joint>", ""), Pose((0, 0, 9)))
    bench.run_steps(50)
    assert bench.world.time == pytest.approx(0.1)
    assert falling.twist.linear[2] == pytest.approx(-0.16, rel=0.01)


@pytest.mark.parametrize("fields", [
    {"time_step": 0.0}, {"time_step": math.nan}, {"max_update_rate": -1.0},
    {"gravity": Vector3(0, 0, math.inf)}, {"ode_config": ode(sor_pgs_iters=4_000_000_000)}])
def test_physics_that_are_none_are_refused(bench, fields):
    # conforms: /gazebo/set_physics_properties/status_message
    answer = set_physics(bench, **fields)
    assert not answer.success and answer.status_message.startswith("SetPhysicsProperties: ")
    assert bench.call("/gazebo/get_physics_properties").time_step == 0.001
