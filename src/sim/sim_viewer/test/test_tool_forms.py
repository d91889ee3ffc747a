"""Requests as YAML, and messages as text."""

import pytest
import yaml
from gazebo_msgs.srv import SetModelStateRequest, SpawnModelRequest
from geometry_msgs.msg import Pose, PoseArray
from rospy import Time
from sensor_msgs.msg import LaserScan
from sim_viewer.registry import Refused
from sim_viewer.tools.messages import fill, load_yaml, template, to_text
from std_msgs.msg import Header, String
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
