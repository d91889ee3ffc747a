"""libgazebo_ros_kobuki.so: TurtleBot2's base."""

import math

import pytest
from kobuki_msgs.msg import BumperEvent, CliffEvent, MotorPower, WheelDropEvent
from std_msgs.msg import Empty

from bullet_sim.pose import Pose

LIBRARY = "libgazebo_ros_kobuki.so"
TAGS = {"left_wheel_joint_name": "left_joint", "right_wheel_joint_name": "right_joint",
        "wheel_separation": 0.4, "wheel_diameter": 0.2, "torque": 5,
        "velocity_command_timeout": 0.6, "publish_tf": 1, "imu_name": "gyro",
        "cliff_sensor_left_name": "cliff_l", "cliff_sensor_center_name": "cliff_c",
        "cliff_sensor_right_name": "cliff_r", "cliff_detection_threshold": 0.2,
        "bumper_name": "bumpers"}
RAY = """<sensor name="{}" type="ray"><pose>{} {} 0 0 1.5707963 0</pose><ray><scan><horizontal>
  <samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
  <range><min>0.01</min><max>0.5</max></range></ray></sensor>"""
SENSORS = ('<sensor name="gyro" type="imu"/><sensor name="bumpers" type="contact"/>'
           + RAY.format("cliff_l", 0.1, 0.13) + RAY.format("cliff_c", 0.17, 0.0)
           + RAY.format("cliff_r", 0.1, -0.13))


@pytest.fixture
def base(robots):
    """`base(tag=value)`: the car of the other drives with a Kobuki's sensors."""
    def make(**tags) -> str:
        chosen = {tag: value for tag, value in {**TAGS, **tags}.items() if value is not None}
        text = robots.two_wheels(robots.plugin(LIBRARY, **chosen), name="turtle")
        return text.replace('<link name="base">', f'<link name="base">{SENSORS}')
    return make


def test_it_drives_until_a_command_is_too_old(bench, base, robots):
    # conforms: libgazebo_ros_kobuki.so, libgazebo_ros_kobuki.so/velocity_command_timeout
    # conforms: libgazebo_ros_kobuki.so/left_wheel_joint_name
    # conforms: libgazebo_ros_kobuki.so/right_wheel_joint_name
    # conforms: libgazebo_ros_kobuki.so/wheel_diameter, libgazebo_ros_kobuki.so/wheel_separation
    car = bench.spawn(base(robotNamespace="/"))
    bench.send("/mobile_base/commands/velocity", robots.command(0.3, turn=0.5))
    bench.run(0.5)
    assert car.joints["left_joint"].velocity == pytest.approx(2.0, abs=0.05)
    assert car.joints["right_joint"].velocity == pytest.approx(4.0, abs=0.05)
    bench.run(0.5)
    assert car.joints["left_joint"].velocity == pytest.approx(0.0, abs=0.02)


def test_odometry_and_joint_states_are_those_of_the_base(bench, base, robots):
    # conforms: libgazebo_ros_kobuki.so/publish_tf, libgazebo_ros_kobuki.so/imu_name
    bench.graph.parameters["/tf_prefix"] = "r1"
    car = bench.spawn(base(robotNamespace="/"), Pose((3.0, 0, 0)))
    odometry, states = bench.listen("/odom"), bench.listen("/joint_states")
    tf, imu = bench.listen("/tf"), bench.listen("/mobile_base/sensors/imu_data")
    bench.send("/mobile_base/commands/velocity", robots.command(-0.3, turn=0.5))
    bench.run(0.5)
    assert len(odometry) == len(states) == len(imu) == len(tf) == 25
    last = odometry[-1]
    assert last.pose.pose.position.x == pytest.approx(-0.15, abs=0.01)
    assert 2 * math.asin(last.pose.pose.orientation.z) == pytest.approx(
        car.pose.rpy()[2], abs=0.01)
    assert last.twist.twist.linear.x == pytest.approx(-0.3, abs=0.01)
    assert list(last.pose.covariance[::7]) == [0.1, 0.1, 1e6, 1e6, 1e6, 0.05]
    assert (last.header.frame_id, last.child_frame_id) == ("r1/odom", "r1/base_footprint")
    assert states[-1].name == ["left_joint", "right_joint"]
    assert len(states[-1].velocity) == len(states[-1].effort) == 2
    assert (tf[-1].transforms[0].header.frame_id,
            tf[-1].transforms[0].child_frame_id) == ("r1/odom", "r1/base_footprint")
    assert imu[-1].header.frame_id == "r1/base_link"
    assert imu[-1].angular_velocity.z == pytest.approx(0.5, abs=0.05)
    assert imu[-1].linear_acceleration.z == pytest.approx(9.8, abs=0.5)
    assert list(imu[-1].orientation_covariance[::4]) == [1e6, 1e6, 0.05]
    bench.send("/mobile_base/commands/reset_odometry", Empty())
    bench.run(0.02)
    assert abs(odometry[-1].pose.pose.position.x) < 0.01


def test_motors_are_switched_off_and_on(bench, base, robots):
    # conforms: libgazebo_ros_kobuki.so
    car = bench.spawn(base())
    assert "/turtle/mobile_base/commands/velocity" in bench.subscribed()  # the model's name
    for state, speed in ((MotorPower.OFF, 0.0), (MotorPower.ON, 0.3)):
        bench.send("/turtle/mobile_base/commands/motor_power", MotorPower(state))
        bench.send("/turtle/mobile_base/commands/velocity", robots.command(0.3))
        bench.run(0.4)
        assert car.twist.linear[0] == pytest.approx(speed, abs=0.02)


def test_prefix_and_torque(bench, base, robots):
    # conforms: libgazebo_ros_kobuki.so/torque, libgazebo_ros_kobuki.so/robotNamespace
    # conforms: libgazebo_ros_kobuki.so/publish_tf
    bench.graph.parameters["/ns/base_prefix"] = "base"
    car = bench.spawn(base(robotNamespace="/ns", torque=0.02, publish_tf=0))
    odometry, tf = bench.listen("/ns/odom"), bench.listen("/tf")
    bench.send("/ns/base/commands/velocity", robots.command(1.0))
    bench.run(0.5)
    assert 0.0 < car.twist.linear[0] < 0.05
    assert (len(odometry), len(tf)) == (25, 0)


def test_bumpers_tell_when_they_are_pressed_and_released(bench, base, robots):
    # conforms: libgazebo_ros_kobuki.so/bumper_name
    bench.spawn(base(robotNamespace="/", velocity_command_timeout=10))
    wall = robots.link("body", "0 0 0 0 0 0", robots.box(0.1, 1.0, 0.2))
    bench.spawn(f'<model name="wall"><static>true</static>{wall}</model>', Pose((0.25, 0, 0.1)))
    events = bench.listen("/mobile_base/events/bumper")
    bench.run(0.1)
    assert not events
    bench.send("/mobile_base/commands/velocity", robots.command(0.3))
    bench.run(0.5)
    assert [(e.bumper, e.state) for e in events][:1] == [(BumperEvent.CENTER, BumperEvent.PRESSED)]
    bench.send("/mobile_base/commands/velocity", robots.command(-0.3))
    bench.run(0.3)
    assert (events[-1].bumper, events[-1].state) == (BumperEvent.CENTER, BumperEvent.RELEASED)
    assert len(events) % 2 == 0


@pytest.mark.parametrize("threshold, cliffs", [
    (0.2, [CliffEvent.LEFT, CliffEvent.CENTER, CliffEvent.RIGHT]), (0.4, [])])
def test_cliffs_are_told(bench, base, threshold, cliffs):
    # conforms: libgazebo_ros_kobuki.so/cliff_sensor_left_name
    # conforms: libgazebo_ros_kobuki.so/cliff_sensor_center_name
    # conforms: libgazebo_ros_kobuki.so/cliff_sensor_right_name
    # conforms: libgazebo_ros_kobuki.so/cliff_detection_threshold
    bench.spawn(base(robotNamespace="/", cliff_detection_threshold=threshold), Pose((0, 0, 0.18)))
    events = bench.listen("/mobile_base/events/cliff")
    bench.run_steps(20)  # still 0.26 m above the floor
    told = [(event.sensor, event.state) for event in events]
    wanted = [(side, CliffEvent.CLIFF) for side in cliffs]
    assert sorted(told) == sorted(wanted)
    bench.run(0.6)
    back = [event for event in events if event.state == CliffEvent.FLOOR]
    assert len(back) == len(wanted)
    for event in back:
        assert event.bottom > 0


@pytest.mark.parametrize("tag", [tag for tag in TAGS if tag != "publish_tf"])
def test_what_is_missing_is_said(bench, base, caplog, tag):
    # conforms: libgazebo_ros_kobuki.so
    bench.spawn(base(**{tag: None}))
    assert f"is not loaded: it needs a <{tag}>" in caplog.text
    assert "/turtle/odom" not in bench.advertised()


def test_a_sensor_that_is_not_there_is_said(bench, base, caplog):
    # conforms: libgazebo_ros_kobuki.so/imu_name
    bench.spawn(base(imu_name="nope"))
    assert "the model has no sensor 'nope'; there are: gyro, bumpers, cliff_l" in caplog.text


def test_the_core_says_what_all_sensors_read(bench, base, robots):
    # conforms: libgazebo_ros_kobuki.so, libgazebo_ros_kobuki.so/cliff_detection_threshold
    car = bench.spawn(base(robotNamespace="/", velocity_command_timeout=10), Pose((0, 0, 0.0)))
    core = bench.listen("/mobile_base/sensors/core")
    bench.send("/mobile_base/commands/velocity", robots.command(0.3))
    bench.run(1.0)
    assert len(core) == 50
    last = core[-1]
    assert (last.bumper, last.wheel_drop, last.cliff, last.charger) == (0, 0, 0, last.DISCHARGING)
    ticks_per_turn = 2578.33
    turned = car.joints["left_joint"].position / math.tau
    assert last.left_encoder == pytest.approx(ticks_per_turn * turned, abs=2)
    assert last.right_encoder == pytest.approx(last.left_encoder, abs=20)
    assert last.time_stamp == pytest.approx(bench.world.time * 1000, abs=20)
    assert len(last.bottom) == 3 and min(last.bottom) > 0
    bench.send("/mobile_base/commands/velocity", robots.command(-0.3))
    bench.run(1.5)
    assert core[-1].left_encoder > 60000  # below zero, in 16 bits


def test_a_lifted_base_tells_of_its_wheels(bench, base):
    # conforms: libgazebo_ros_kobuki.so
    car = bench.spawn(base(robotNamespace="/"))
    events = bench.listen("/mobile_base/events/wheel_drop")
    core = bench.listen("/mobile_base/sensors/core")
    bench.run(0.5)
    assert not events
    car.set_pose(Pose((0, 0, 1.0)))
    bench.run(0.3)
    both = [(WheelDropEvent.LEFT, WheelDropEvent.DROPPED),
            (WheelDropEvent.RIGHT, WheelDropEvent.DROPPED)]
    assert [(event.wheel, event.state) for event in events] == both
    assert (core[-1].wheel_drop, core[-1].cliff) == (3, 7)
    bench.run(0.7)
    assert [event.state for event in events[2:]] == [WheelDropEvent.RAISED] * 2
    assert core[-1].wheel_drop == 0
    bench.call("/gazebo/reset_simulation")
    bench.run(0.3)
    assert core[-1].wheel_drop == 0


def test_the_core_has_a_bit_for_each_bumper(bench, base, robots):
    # conforms: libgazebo_ros_kobuki.so/bumper_name
    bench.spawn(base(robotNamespace="/", velocity_command_timeout=10))
    wall = robots.link("body", "0 0 0 0 0 0", robots.box(0.1, 1.0, 0.2))
    bench.spawn(f'<model name="wall"><static>true</static>{wall}</model>', Pose((0.25, 0, 0.1)))
    core = bench.listen("/mobile_base/sensors/core")
    bench.send("/mobile_base/commands/velocity", robots.command(0.3))
    bench.run(0.5)
    assert 2 in {message.bumper for message in core}  # the centre one
