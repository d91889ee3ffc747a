"""What a page may ask of the tab RViz, what its tools publish, and where frames are."""

import asyncio
import math
import time
from types import SimpleNamespace

import pytest
import rospy
from geometry_msgs.msg import TransformStamped, Vector3
from rviz_messages import turned
from sim_viewer.options import Options
from sim_viewer.registry import Context, Node, Refused
from sim_viewer.rviz import tools
from sim_viewer.rviz.display import Display, Displays
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.page import rviz_config, rviz_types
from sim_viewer.rviz.tools import TOOLS, Publishers, rviz_publish
from sim_viewer.rviz.types import TYPES
from sim_viewer.tools.clock import SharedClock
from sim_viewer.transforms import NANO, NoPose, Transforms
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage


@pytest.fixture
def context():
    loop = asyncio.new_event_loop()
    node = Node(Options(control=True), loop)
    yield Context(node, 1)
    node.close()
    loop.close()


HONEST = {"display": 1, "class": "rviz/Grid", "frame": "map", "options": {"Alpha": 0.5}}


@pytest.mark.parametrize("changes, said", [
    ({"class": "somebody/Else"}, "not supported here"), ({"class": 3}, "not of type str"),
    ({"display": "1"}, "not of type int"), ({"frame": None}, "not of type str"),
    ({"options": []}, "not of type dict"), ({"options": {"Alpha": 2}}, "number from 0 to 1"),
    ({"options": {"Alpha": 10 ** 400}}, "number from 0 to 1"),
    ({"options": {"Alpha": True}}, "number from 0 to 1"),
    ({"options": {"Plane": ["XY"]}}, "is not one of XY, XZ, YZ"),
    ({"options": {"Color": "1; 2; 300"}}, "colour such as"),
    ({"options": {"Plane Cell Count": 10 ** 9}}, "integer from 1 to 1000"),
    ({"options": {"Depth": 1}}, "no option 'Depth'"),
])
def test_what_does_not_fit_is_refused(context, changes, said):
    with pytest.raises(Refused, match=said):
        Display(context, HONEST | changes, print)


def test_a_number_belongs_to_one_display(context):
    context.node.shared(Displays)[1, 1] = object()
    with pytest.raises(Refused, match="another one's number"):
        context.loop.run_until_complete(Display(context, HONEST, print).start())


@pytest.fixture
def laser(context, monkeypatch):
    """Makes a display of a topic; nothing is subscribed to but counted."""
    for kind in (Transforms, SharedClock):
        monkeypatch.setattr(kind, "subscribe", lambda _: SimpleNamespace(unregister=lambda: None))
    return lambda topic: Display(
        context, {"display": 1, "class": "rviz/LaserScan", "frame": "map", "topic": topic}, print)


def test_a_page_that_goes_while_a_display_is_opened_leaves_nothing_subscribed(context, laser):
    shown = laser("")
    context.loop.run_until_complete(shown.stop())
    shown._open()  # in its thread, which nobody can stop
    assert context.node.shared(Transforms)._holders == 0


@pytest.mark.parametrize("topic", ["a b", "~mine", "/a" * 200])
def test_what_is_no_name_of_a_topic_is_not_subscribed_to(laser, topic, monkeypatch):
    monkeypatch.setattr(rospy, "Subscriber", None)
    shown = laser(topic)
    shown._open()
    level, text = shown._showing.statuses["Topic"]
    assert level == "error" and "is not the name of a topic" in text and len(text) < 100


def test_a_message_that_is_too_large_is_not_read(laser):
    raw = SimpleNamespace(_buff=bytes(20 << 20),
                          _connection_header={"type": "sensor_msgs/LaserScan"})
    with pytest.raises(Problem, match="of 20 MB is larger than the 16 MB"):
        laser("/scan")._read(raw)


def test_the_page_is_told_of_all_displays_and_of_the_file(context):
    ask = context.loop.run_until_complete
    assert [kind["class"] for kind in ask(rviz_types(context))] == list(TYPES)
    assert ask(rviz_config(context))["fixed_frame"] == ""
    object.__setattr__(context.node.options, "rviz", "/gone.rviz")
    with pytest.raises(Refused, match=r"/gone\.rviz: No such file"):
        ask(rviz_config(context))


# --- tools

def test_tools_publish_what_rviz_publishes():
    header = Header(frame_id="map")
    made = {tool: make(header, 1.0, 2.0, 3.0, math.pi / 2) for tool, (_, make) in TOOLS.items()}
    for tool, message in made.items():
        assert isinstance(message, TOOLS[tool][0]) and message.header is header
    goal, estimate = made["goal"].pose, made["initial_pose"].pose
    assert goal == estimate.pose
    assert (goal.position.x, goal.position.y, goal.position.z) == (1.0, 2.0, 0.0)
    assert (goal.orientation.z, goal.orientation.w) == pytest.approx((math.sqrt(0.5),) * 2)
    assert {i: value for i, value in enumerate(estimate.covariance) if value} == {
        0: 0.25, 7: 0.25, 35: 0.06853891945200942}
    assert made["point"].point.z == 3.0


def test_tools_are_refused_what_is_no_topic_and_places_that_are_far_off(context):
    publishers = context.node.shared(Publishers)
    for tool, topic, said in (("drive", "/goal", "no tool 'drive'"), ("goal", "a b", "not the"),
                              ("goal", "~goal", "not the"), ("goal", "/" * 300, "not the")):
        with pytest.raises(Refused, match=said):
            publishers.open(tool, topic)
    with pytest.raises(Refused, match="no fixed frame yet"):
        context.loop.run_until_complete(rviz_publish(context, "goal", "/goal", "", 1.0, 0.0))
    with pytest.raises(Refused, match="farther than"):
        context.loop.run_until_complete(rviz_publish(context, "goal", "/goal", "map", 1e9, 0.0))


class SlowPublisher:
    """One whose two subscribers connect one after the other."""

    def __init__(self, name, kind, queue_size):
        self.looks, self.sent = 0, []

    def get_num_connections(self):
        self.looks += 1
        return min(self.looks // 3, 2)

    def publish(self, message):
        self.sent.append((message, self.looks))


def test_a_click_right_after_the_tool_was_taken_waits_for_all_who_listen(context, monkeypatch):
    monkeypatch.setattr(tools, "connect", lambda: SimpleNamespace(getSystemState=lambda: [
        [], [["/clicked_point", ["/sim_viewer", "/listener"]]], []]))
    publishers = context.node.shared(Publishers)
    key = "point", "/clicked_point"
    publishers._publishers[key] = SlowPublisher(*key, 1), time.monotonic() + 60.0  # being opened
    assert publishers.publish(*key, "map", (1.0, 2.0, 0.0, 0.0)) == 2
    ((message, looks),) = publishers._publishers[key][0].sent
    assert looks >= 6 and message.header.frame_id == "map"


# --- frames

def transform(parent, child, x, stamp=0.0, yaw=0.0):
    made = TransformStamped(Header(0, rospy.Time.from_sec(stamp), parent), child, None)
    made.transform.translation, made.transform.rotation = Vector3(x, 0.0, 0.0), turned(yaw)
    return made


def test_frames_are_placed_at_the_time_that_is_asked_for():
    frames = Transforms()
    frames._take(TFMessage([transform("map", "odom", 1.0)]), True)
    for stamp in (10.0, 11.0):
        frames._take(TFMessage([transform("/odom", "/base", stamp - 9.0, stamp)]), False)
    assert frames.frames() == {"map": "", "odom": "map", "base": "odom"}
    assert frames.pose("map", "base", 10_500_000_000).position[0] == pytest.approx(2.5)
    assert frames.pose("map", "base").position[0] == pytest.approx(3.0)  # the newest
    assert frames.pose("moon", "moon").position == (0.0, 0.0, 0.0)
    for frame, stamp in (("base", 12 * NANO), ("base", -NANO), ("moon", 0), ("", 0)):
        with pytest.raises(NoPose):
            frames.pose("map", frame, stamp)


def test_a_message_is_placed_at_its_own_nanosecond():
    frames = Transforms()
    stamp = rospy.Time(100, 300_000_000)  # Time.from_sec(100.3) is 1 ns earlier
    only = transform("odom", "base", 5.0)
    only.header.stamp = stamp
    frames._take(TFMessage([only]), False)
    assert frames.pose("odom", "base", stamp.to_nsec()).position[0] == 5.0


def test_frames_are_forgotten_when_a_simulator_begins_anew():
    frames = Transforms()
    frames._take(TFMessage([transform("map", "odom", 1.0)]), True)
    frames._take(TFMessage([transform("odom", "base", 5.0, 100.0)]), False)
    frames._take(TFMessage([transform("odom", "base", 1.0, 0.5)]), False)
    assert frames.pose("map", "base").position[0] == pytest.approx(2.0)
