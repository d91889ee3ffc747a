"""Requests as YAML, messages as text, paths to their numbers, and what a page may ask."""

import pytest
import yaml
from gazebo_msgs.srv import SetModelStateRequest, SpawnModelRequest
from geometry_msgs.msg import Pose, PoseArray
from nav_msgs.msg import Odometry
from rospy import Time
from sensor_msgs.msg import JointState, LaserScan
from sim_viewer import registry
from sim_viewer.registry import Refused
from sim_viewer.tools.messages import (
    expand,
    fill,
    load_yaml,
    numeric_paths,
    parse_steps,
    split_topic,
    template,
    to_text,
    value,
)
from std_msgs.msg import Header, String, UInt8MultiArray
from std_srvs.srv import EmptyRequest, SetBoolRequest
from turtlesim.srv import SetPenRequest, SpawnRequest


@pytest.mark.parametrize("kind", [SetModelStateRequest, SpawnModelRequest, EmptyRequest,
                                  SetBoolRequest, SpawnRequest, Header])
def test_a_template_as_it_stands_is_the_default(kind):
    assert fill(kind, template(kind)) == kind()


def test_a_filled_in_template_is_the_message():
    text = template(SpawnRequest).replace("x: 0.0", "x: 2.5").replace('""', "leo")
    assert fill(SpawnRequest, text) == SpawnRequest(2.5, 0.0, 0.0, "leo")
    state = fill(SetModelStateRequest, "{model_state: {pose: {position: {x: 3}}}}").model_state
    assert state.pose.position.x == 3
    assert fill(EmptyRequest, "") == EmptyRequest()


@pytest.mark.parametrize("kind, text, reason", [
    (SpawnRequest, "xx: 1", "no field 'xx'; turtlesim/SpawnRequest has: x, y, theta, name"),
    (SpawnRequest, "x: left", "x is 'left', which is not of type float32"),
    (SpawnRequest, "name: 5", "name is 5, which is not of type string"),
    (SpawnRequest, "[1, 2]", "a list of `field: value`"),
    (SpawnRequest, "x: [1", "not YAML: line 1"),
    (SetPenRequest, "r: 256", "r is 256, which is not of type uint8"),
    (SetBoolRequest, "data: 1", "data is 1, which is not of type bool"),
    (SetModelStateRequest, "model_state: {pose: {position: 3}}", "model_state.pose.position is 3"),
    (SetModelStateRequest, "model_state: {pose: {position: {x: {}}}}", "position.x is {}"),
    (Header, "stamp: soon", "stamp is 'soon'"),
    (Header, "stamp: {secs: soon, nsecs: 0}", "stamp is {'secs': 'soon'"),
    (Header, "stamp: {secs: -1, nsecs: 0}", "stamp is {'secs': -1"),
    (Header, "x" * 900 + ": 1", f"no field '{'x' * 79}; "),
    (Header, "seq: !!int ''", "not YAML"), (Header, "seq: !!bool x", "not YAML"),
])
def test_a_wrong_request_has_one_line_that_names_the_field(kind, text, reason):
    with pytest.raises(Refused) as refused:
        fill(kind, text)
    assert reason in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", [
    "a: &b [1]\nc: *b", "[" * 5000, "x: " + "9" * 6000, "a" * 20_001,
    "!!python/object:os.system {}",
])
def test_hostile_yaml_is_refused(text):
    with pytest.raises(Refused):
        load_yaml(text)


def test_a_message_as_text_is_yaml_with_its_values():
    message = Header(seq=3, stamp=Time(7, 5), frame_id='a "b"\n\x01')
    assert yaml.safe_load(to_text(message)) == {
        "seq": 3, "stamp": {"secs": 7, "nsecs": 5}, "frame_id": 'a "b"\n\x01'}


def test_long_arrays_and_texts_are_cut_and_say_so():
    text = to_text(LaserScan(ranges=[1.0] * 360))
    assert len(yaml.safe_load(text)["ranges"]) == 24
    assert "# ... 360 in all" in text
    assert len(yaml.safe_load(to_text(LaserScan(ranges=[1.0] * 360), 500))["ranges"]) == 360
    assert len(to_text(String("x" * 100_000))) < 2_100


def test_lists_of_messages_are_yaml_lists():
    message = PoseArray(poses=[Pose(), Pose()])
    poses = yaml.safe_load(to_text(message))["poses"]
    assert len(poses) == 2
    assert poses[0]["position"] == {"x": 0.0, "y": 0.0, "z": 0.0}


def test_the_longest_topic_that_fits_is_taken():
    topics = ["/odom", "/odom/raw", "/odometry"]
    assert split_topic("/odom/pose/pose/position/x", topics) == ("/odom", "pose/pose/position/x")
    assert split_topic("/odom/raw/data", topics) == ("/odom/raw", "data")
    assert split_topic("/odom", topics) == ("/odom", "")
    with pytest.raises(Refused, match="/odo/x: no such topic"):
        split_topic("/odo/x", topics)


def test_elements_have_two_spellings():
    assert parse_steps("ranges[10]") == parse_steps("ranges/10") == ["ranges", 10]
    assert parse_steps("a/b[0][2]/c") == ["a", "b", 0, 2, "c"]
    for wrong in ("a[", "a[-1]", "a b", "__class__", "a[1]x", "a[9999999999]"):
        with pytest.raises(Refused):
            parse_steps(wrong)


def test_values_are_the_messages_own():
    odometry = Odometry()
    odometry.pose.pose.position.x = 1.25
    odometry.pose.covariance = [float(i) for i in range(36)]
    odometry.header.stamp = Time(3, 500_000_000)
    assert value(odometry, parse_steps("pose/pose/position/x")) == 1.25
    assert value(odometry, parse_steps("pose/covariance[35]")) == 35.0
    assert value(odometry, parse_steps("header/stamp")) == 3.5
    assert value(LaserScan(ranges=[1.0]), parse_steps("ranges[1]")) is None
    assert value(UInt8MultiArray(data=b"\x07"), parse_steps("data[0]")) == 7.0


def test_a_path_may_stand_for_several_lines():
    assert expand("pose/pose/position/x:y", Odometry) == [
        "pose/pose/position/x", "pose/pose/position/y"]
    assert expand("twist/twist/linear", Odometry) == [
        f"twist/twist/linear/{axis}" for axis in "xyz"]
    assert expand("", LaserScan)[:2] == ["angle_min", "angle_max"]


@pytest.mark.parametrize("path, message_class, reason", [
    ("pose/pose/position/w", Odometry, "Point has no field 'w'; it has: x, y, z"),
    ("child_frame_id", Odometry, "string is not a number"),
    ("pose/covariance", Odometry, r"it has: an index as \[0\]"),
    ("pose[0]", Odometry, "has no elements"),
    ("data", String, "string is not a number"),
    ("", Odometry, "it has: header, child_frame_id, pose, twist"),
])
def test_what_is_no_number_is_told_with_what_there_is(path, message_class, reason):
    with pytest.raises(Refused, match=reason):
        expand(path, message_class)


def test_the_numbers_of_a_type_are_all_offered_and_all_fit():
    for message_class in (Odometry, LaserScan, JointState):
        paths = numeric_paths(message_class)
        assert [expand(path, message_class) for path in paths] == [[path] for path in paths]
    assert "position[0]" in numeric_paths(JointState)
    assert "name[0]" not in numeric_paths(JointState)


LOOKING = {"bag_info", "parameter", "parameters", "plot_expand", "plot_fields", "rviz_change",
           "rviz_config", "rviz_drawn", "rviz_types", "service", "services"}
CHANGING = {"call_service", "delete_parameter", "pause", "play", "record", "reset", "rewind",
            "rviz_feedback", "rviz_menu", "rviz_publish", "rviz_tool", "set_parameter", "step",
            "stop_play", "stop_record"}


def test_only_looking_needs_no_control():
    registry.load_all()
    tools = {name: operation for name, operation in registry._operations.items()
             if operation.function.__module__.startswith(("sim_viewer.rviz.", "sim_viewer.tools."))}
    assert {name for name, operation in tools.items() if not operation.control} == LOOKING
    assert {name for name, operation in tools.items() if operation.control} == CHANGING
