"""Robots, worlds and launch files in the styles of public packages: they load, stand and speak."""

import logging
import math
import re
from unittest.mock import Mock

import pytest
import rospy
from style_stage import FOLDER, Stage, lowest_point, read_styles, value_at
from tf2_msgs.msg import TFMessage

SETTLING, LISTENING = 1.0, 4.0  # s
DEEPEST = 0.01  # m below the floor
SHARED = {"/clock", "/tf"}  # topics of the simulator itself
STYLES = read_styles()


@pytest.fixture
def stage(make_bench, graph, monkeypatch):
    """`stage(style)`: a bench with it, the models of this folder on the model path."""
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(FOLDER / "models"))
    monkeypatch.setattr(rospy, "search_param", lambda _name: None)  # actionlib asks the master
    monkeypatch.setattr(rospy, "Timer", Mock())  # and starts a thread that would outlive the test
    return lambda style: Stage(make_bench, graph, style)


def frames(messages) -> set[str]:
    """Header frames; of transforms "parent -> child"."""
    found = set()
    for message in messages:
        if isinstance(message, TFMessage):
            found |= {f"{t.header.frame_id} -> {t.child_frame_id}" for t in message.transforms}
        elif hasattr(message, "header"):
            found.add(message.header.frame_id)
    return found


def check_models(world, expected):
    assert set(world.models) - {"ground_plane"} == set(expected)
    for name, parts in expected.items():
        model = world.models[name]
        for kind, found in (("links", model.links), ("joints", model.joints)):
            if kind in (parts or {}):
                assert sorted(found) == sorted(parts[kind]), f"{kind} of {name}"
        if "at" in (parts or {}):
            assert model.pose.position == pytest.approx(parts["at"], abs=0.02), name


def check_motion(world, floor):
    for name, model in world.models.items():
        states = [value for pose, twist in model.link_states().values()
                  for value in (*pose.position, *pose.orientation, *twist.linear, *twist.angular)]
        states += [value for joint in model.joints.values()
                   for value in (joint.position, joint.velocity)]
        assert all(map(math.isfinite, states)) and not model.has_recovered, name
        if floor is not None and not model.static:
            assert lowest_point(model) > floor - DEEPEST, name


def check_topics(bench, expected, heard):
    for topic, (kind, rate, *frame) in expected.items():
        assert bench.advertised()[topic]._type == kind, topic
        assert len(heard[topic]) == pytest.approx(rate * LISTENING, rel=0.02, abs=1.0), topic
        assert frames(heard[topic]) == set(frame), topic


def check_readings(expected, heard):
    for topic, readings in expected.items():
        for path, value in readings.items():
            found = value_at(heard[topic][-1], path)
            if isinstance(value, (int, float)):
                value = pytest.approx(value, rel=0.02, abs=0.02)
            assert found == value, f"{topic} {path}"


def check_reached(world, expected, within):
    for place, value in expected.items():
        name, _, joint = place.partition("/")
        model = world.models[name]
        if joint:
            found = model.joints[joint].position
        else:  # x, y and yaw, the one next to what is expected
            yaw = value[2] + math.remainder(model.pose.rpy()[2] - value[2], 2 * math.pi)
            found = (*model.pose.position[:2], yaw)
        assert found == pytest.approx(value, abs=within), place


def check_reset_and_end(bench, floor, heard):
    """A reset starts everything anew; with the last model all its topics and services are gone."""
    bench.call("/gazebo/reset_simulation")
    for messages in heard.values():
        messages.clear()
    bench.run(0.6)
    check_motion(bench.world, floor)
    for topic, messages in heard.items():
        assert messages, f"{topic} is silent after a reset"
    for name in list(bench.world.models):
        bench.call("/gazebo/delete_model", model_name=name)
    bench.run(0.1)
    left = {*bench.advertised(), *bench.subscribed(), *bench.graph.services} - SHARED
    assert not [name for name in left if not name.startswith("/gazebo")]


def check_warnings(records, expected, missing):
    said = [record.getMessage() for record in records]
    for pattern in (*expected, *(rf"missing <{tag}> default is " for tag in missing)):
        matching = [line for line in said if re.search(pattern, line)]
        assert matching, f"nothing said matches {pattern!r}, but: {said}"
        said.remove(matching[0])
    assert said == []


@pytest.mark.parametrize("name", STYLES)
def test_a_style_works_unchanged(stage, caplog, name):
    # conforms: libgazebo_ros_diff_drive.so, libgazebo_ros_skid_steer_drive.so
    # conforms: libgazebo_ros_planar_move.so, libgazebo_ros_tricycle_drive.so
    # conforms: libgazebo_ros_kobuki.so, libgazebo_ros_control.so, libgazebo_ros_p3d.so
    # conforms: libgazebo_ros_laser.so, libgazebo_ros_gpu_laser.so, libgazebo_ros_camera.so
    # conforms: libgazebo_ros_multicamera.so, libgazebo_ros_openni_kinect.so
    # conforms: libgazebo_ros_imu.so, libgazebo_ros_imu_sensor.so, libgazebo_ros_range.so
    # conforms: libgazebo_ros_bumper.so, libgazebo_ros_joint_state_publisher.so
    # conforms: libhector_gazebo_ros_imu.so, libhector_gazebo_ros_gps.so
    # conforms: libhector_gazebo_ros_baro.so, libhector_gazebo_ros_magnetic.so
    # conforms: libhector_gazebo_ros_sonar.so, libgazebo_ros_velodyne_laser.so
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so, sdf state, sdf population, sdf actor
    style = STYLES[name]
    with caplog.at_level(logging.WARNING):
        found = stage(style)
        bench = found.bench
        heard = {topic: bench.listen(topic) for topic in style.topics}
        bench.run(SETTLING)
        check_motion(bench.world, style.floor)
        for messages in heard.values():
            messages.clear()
        bench.run(LISTENING)
        check_models(bench.world, style.models)
        check_motion(bench.world, style.floor)
        check_topics(bench, style.topics, heard)
        check_readings(style.reads, heard)
        if style.send:
            found.send()
            bench.run(style.seconds)
            check_motion(bench.world, style.floor)
        check_reached(bench.world, style.reaches, style.within)
        check_reset_and_end(bench, style.floor, heard)
    check_warnings(caplog.records, style.warnings, style.missing)


def test_every_file_of_the_folder_is_a_style_or_part_of_one():
    named = {style.file.split("/")[0] for style in STYLES.values()}
    named |= {style.parameters.split("/")[0] for style in STYLES.values()}
    there = {path.name for path in FOLDER.iterdir()} - {"expected.yaml", "models", "parts"}
    assert there <= named
    assert len(STYLES) >= 32
