"""Wrenches and efforts that services of /gazebo bring."""

import math

import pytest
import rospy
from geometry_msgs.msg import Point, Vector3, Wrench

from bullet_sim.pose import Pose

INERTIA = "<inertia><ixx>0.3</ixx><iyy>0.4</iyy><izz>0.5</izz></inertia>"
BOX = f"""<model name="box"><link name="body"><gravity>false</gravity>
  <inertial><mass>2</mass>{INERTIA}</inertial></link></model>"""
ARM = f"""<model name="arm"><link name="base"/><link name="tip"><gravity>false</gravity>
    <inertial><mass>1</mass>{INERTIA}</inertial></link>
  <joint name="root" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="hinge" type="revolute"><parent>base</parent><child>tip</child>
    <axis><xyz>0 0 1</xyz><limit><effort>3</effort></limit></axis></joint></model>"""


def near(*values):
    return pytest.approx(values, abs=1e-5)


def seconds(value):
    return rospy.Duration.from_sec(value)


def push(bench, force=(4.0, 0, 0), torque=(0, 0, 0), duration=-1.0, **fields):
    return bench.call("/gazebo/apply_body_wrench", **dict(dict(
        body_name="box::body", wrench=Wrench(Vector3(*force), Vector3(*torque)),
        duration=seconds(duration)), **fields))


def test_a_force_for_as_long_as_it_is_asked_for(bench):
    # conforms: /gazebo/apply_body_wrench, /gazebo/apply_body_wrench/body_name
    # conforms: /gazebo/apply_body_wrench/wrench, /gazebo/apply_body_wrench/duration
    # conforms: /gazebo/apply_body_wrench/success, /gazebo/apply_body_wrench/status_message
    box = bench.spawn(BOX)
    answer = push(bench, duration=0.1)
    assert (answer.success, answer.status_message) == (True, "")
    bench.run(0.3)
    assert box.twist.linear == near(0.2, 0, 0)
    answer = push(bench, body_name="box::wheel")
    assert (answer.success, answer.status_message) == (
        False, "ApplyBodyWrench: body does not exist")


def test_a_force_without_duration_does_nothing(bench):
    # conforms: /gazebo/apply_body_wrench/duration
    box = bench.spawn(BOX)
    push(bench, duration=0.0)
    bench.run(0.1)
    assert box.twist.linear == near(0, 0, 0)


def test_a_force_for_ever_is_cleared_by_its_exact_name(bench):
    # conforms: /gazebo/apply_body_wrench/duration, /gazebo/clear_body_wrenches
    # conforms: /gazebo/clear_body_wrenches/body_name
    box = bench.spawn(BOX)
    push(bench)
    bench.run(0.1)
    bench.call("/gazebo/clear_body_wrenches", body_name="body")
    bench.run(0.1)
    assert box.twist.linear == near(0.4, 0, 0)
    bench.call("/gazebo/clear_body_wrenches", body_name="box::body")
    bench.call("/gazebo/clear_body_wrenches", body_name="box::body")  # none is no error
    bench.run(0.1)
    assert box.twist.linear == near(0.4, 0, 0)


def test_a_force_that_begins_later(bench):
    # conforms: /gazebo/apply_body_wrench/start_time
    box = bench.spawn(BOX)
    push(bench, start_time=rospy.Time(0, 200_000_000))
    bench.run(0.1)
    assert box.twist.linear == near(0, 0, 0)
    bench.run(0.2)
    assert box.twist.linear == near(0.2, 0, 0) or box.twist.linear == near(0.202, 0, 0)


def test_a_start_in_the_past_is_now(bench):
    # conforms: /gazebo/apply_body_wrench/start_time
    box = bench.spawn(BOX)
    bench.run(0.5)
    push(bench, start_time=rospy.Time(0, 100_000_000), duration=0.1)
    bench.run(0.3)
    assert box.twist.linear == near(0.2, 0, 0)


def test_a_force_beside_the_centre_of_mass_turns(bench):
    # conforms: /gazebo/apply_body_wrench/reference_point
    box = bench.spawn(BOX)
    push(bench, force=(0, 4.0, 0), reference_point=Point(0.5, 0, 0), duration=0.01)
    bench.run(0.02)
    assert box.twist.angular == near(0, 0, 0.5 * 4.0 * 0.01 / 0.5)


def test_a_frame_turns_the_wrench_into_the_axes_of_the_body(bench):
    # conforms: /gazebo/apply_body_wrench/reference_frame
    turned = Pose.from_xyz_rpy((0, 0, 0), (0, 0, math.pi / 2))
    box = bench.spawn(BOX, turned)
    frame = bench.spawn(BOX, Pose((0, -0.25, 0)), "frame")  # 0.25 m along the body's -x
    push(bench, reference_frame="box::body", duration=0.01)
    bench.run(0.02)
    assert box.twist.linear == near(0.02, 0, 0)  # along the world's x, as upstream
    push(bench, reference_frame="frame", duration=0.01)
    bench.run(0.02)
    assert box.twist.linear == near(0.02, -0.02, 0)
    assert box.twist.angular == pytest.approx((0, 0, 0.25 * 4.0 * 0.01 / 0.5), rel=0.01)
    assert frame.twist.linear == near(0, 0, 0)
    answer = push(bench, reference_frame="odom")
    assert (answer.success, answer.status_message) == (
        False, "ApplyBodyWrench: reference_frame not found")


def test_the_last_wrench_on_a_body_is_the_one_that_counts(bench):
    # conforms: /gazebo/apply_body_wrench/wrench
    box = bench.spawn(BOX)
    push(bench, force=(1.0, 0, 0))
    push(bench, force=(4.0, 0, 0), duration=0.1)
    bench.run(0.1)
    assert box.twist.linear == near(0.2, 0, 0)


def test_a_torque_is_about_the_worlds_axes(bench):
    # conforms: /gazebo/apply_body_wrench/wrench
    box = bench.spawn(BOX, Pose.from_xyz_rpy((0, 0, 0), (0, math.pi / 2, 0)))
    push(bench, force=(0, 0, 0), torque=(0, 0, 0.5), duration=0.1)
    bench.run(0.2)
    assert box.twist.angular == pytest.approx((0, 0, 0.5 * 0.1 / 0.3), abs=1e-3)  # ixx resists


def test_an_effort_for_as_long_as_it_is_asked_for(bench):
    # conforms: /gazebo/apply_joint_effort, /gazebo/apply_joint_effort/joint_name
    # conforms: /gazebo/apply_joint_effort/effort, /gazebo/apply_joint_effort/duration
    # conforms: /gazebo/apply_joint_effort/success, /gazebo/apply_joint_effort/status_message
    joint = bench.spawn(ARM).joint("hinge")
    answer = bench.call("/gazebo/apply_joint_effort", joint_name="hinge", effort=0.5,
                        duration=seconds(0.1))
    assert (answer.success, answer.status_message) == (True, "ApplyJointEffort: effort set")
    bench.run(0.2)
    assert joint.velocity == pytest.approx(0.1, rel=1e-3)
    bench.call("/gazebo/apply_joint_effort", joint_name="hinge", effort=-9.0,
               duration=seconds(0.1))
    bench.run(0.2)
    assert joint.velocity == pytest.approx(0.1 - 0.6, rel=1e-2)  # cut to the joint's own limit
    answer = bench.call("/gazebo/apply_joint_effort", joint_name="elbow", effort=1.0)
    assert (answer.success, answer.status_message) == (
        False, "ApplyJointEffort: joint not found")


def test_an_effort_begins_later_and_is_cleared(bench):
    # conforms: /gazebo/apply_joint_effort/start_time, /gazebo/clear_joint_forces
    # conforms: /gazebo/clear_joint_forces/joint_name
    joint = bench.spawn(ARM).joint("hinge")
    bench.call("/gazebo/apply_joint_effort", joint_name="hinge", effort=0.5,
               start_time=rospy.Time(0, 100_000_000), duration=seconds(-1))
    bench.run(0.099)
    assert joint.velocity == 0.0
    bench.run(0.1)
    assert joint.velocity == pytest.approx(0.1, rel=0.01)
    bench.call("/gazebo/clear_joint_forces", joint_name="elbow")
    bench.run(0.1)
    bench.call("/gazebo/clear_joint_forces", joint_name="hinge")
    bench.run(0.1)
    assert joint.velocity == pytest.approx(0.2, rel=0.01)


def test_forces_of_a_model_that_is_deleted_are_dropped(bench):
    # conforms: /gazebo/delete_model
    bench.spawn(BOX)
    push(bench)
    bench.call("/gazebo/delete_model", model_name="box")
    box = bench.spawn(BOX)
    bench.run(0.1)
    assert box.twist.linear == near(0, 0, 0)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_forces_that_are_no_numbers_are_refused(bench, value):
    # conforms: /gazebo/apply_body_wrench/wrench, /gazebo/apply_joint_effort/effort
    bench.spawn(BOX)
    bench.spawn(ARM)
    assert "finite" in push(bench, force=(value, 0, 0)).status_message
    assert "finite" in bench.call("/gazebo/apply_joint_effort", joint_name="hinge",
                                  effort=value).status_message
