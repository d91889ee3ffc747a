"""Who sends and who hears: which faults are named, when, and which graphs are none."""

import time
from http.client import IncompleteRead
from types import SimpleNamespace

import pytest
import rospy

from bullet_sim_ros import topic_faults
from bullet_sim_ros.topic_faults import (
    AGAIN,
    PATIENCE,
    RECENT,
    Fault,
    Graph,
    Reports,
    Senders,
    contested,
    mistyped,
    typed,
    unheard,
    unseen,
)

ME = "/gazebo"
TWIST, IMAGE, FLOAT = "geometry_msgs/Twist", "sensor_msgs/Image", "std_msgs/Float64"
CAMERA = "/camera/rgb/image_raw"


def graph(publishers, subscribers, **types):
    kinds = {"cmd_vel": TWIST, "image_raw": IMAGE, "image": IMAGE, "command": FLOAT,
             "error": FLOAT, "nav_vel": TWIST, **types}
    return Graph(publishers, subscribers,
                 {topic: kinds[topic.rpartition("/")[2]] for topic in (*publishers, *subscribers)})


def lines(faults):
    return [fault.text % fault.values for fault in faults]


def note(senders, caller, topic="/cmd_vel"):
    senders.note(topic, SimpleNamespace(_connection_header={"callerid": caller}))


def test_two_that_send_at_once_are_two_drivers(monkeypatch):
    now = 100.0
    monkeypatch.setattr("bullet_sim_ros.topic_faults.time.monotonic", lambda: now)
    senders, types = Senders(), {"/cmd_vel": TWIST, "/tf": "tf2_msgs/TFMessage"}
    note(senders, "/teleop")
    senders.note("/cmd_vel", SimpleNamespace())  # without a header, as in tests
    assert not lines(contested(senders.recent(now), types))
    note(senders, "/follower_12")
    note(senders, "/a", "/tf")
    note(senders, "/b", "/tf")
    line, = lines(contested(senders.recent(now), types))
    assert line.startswith("/follower_12, /teleop send commands on /cmd_vel")
    now += RECENT + 0.1  # the teleop is silent now: one took over from the other
    note(senders, "/follower_12")
    assert not lines(contested(senders.recent(now), types))


def test_two_nodes_on_all_topics_of_a_car_are_one_line():
    topics = [f"/racecar/wheel_{number}/command" for number in range(6)]
    line, = lines(contested({topic: ["/one", "/two"] for topic in topics},
                            dict.fromkeys(topics, FLOAT)))
    assert line.startswith(f"/one, /two send commands on {', '.join(topics[:5])} ... at the same")


def test_who_is_silent_is_forgotten():
    senders = Senders()
    for number in range(1000):
        note(senders, f"/follower_{number}", f"/topic_{number % 10}")
    assert not senders.recent(time.monotonic() + RECENT + 0.1) and not senders._last


@pytest.mark.parametrize(("node", "named"), [
    ("/rviz_17_2899", False), ("/tb3_0/rviz", False), ("/rqt_gui_py_node_711", False),
    ("/record_1712", False), ("/record_images", True), ("/rvizual", True), ("/rosouter", True)])
def test_only_what_shows_images_itself_is_left_out(node, named):
    seen = graph({CAMERA: [ME]}, {"/camera/image_raw": [node]})
    assert bool(lines(unseen(seen, ME))) is named


def test_a_command_that_nobody_hears_names_the_robots_topic():
    line, = lines(unheard(graph({"/cmd_vel": ["/teleop"]},
                                {"/tb3_0/cmd_vel": [ME], "/tb3_1/cmd_vel": [ME]}), ME))
    assert line == ("/teleop sends commands on /cmd_vel, but nobody hears them there; the robot "
                    "listens on /tb3_0/cmd_vel, /tb3_1/cmd_vel")
    line, = lines(unheard(graph({"/racecar/front_controller/command": ["/me"]},
                                {"/racecar/left_controller/command": [ME]}), ME))
    assert "/racecar/left_controller/command" in line


@pytest.mark.parametrize("publishers, subscribers", [
    ({"/cmd_vel": ["/teleop"]}, {"/cmd_vel": [ME]}),
    ({"/nav_vel": ["/move_base"], "/cmd_vel": ["/mux"]}, {"/nav_vel": ["/mux"], "/cmd_vel": [ME]}),
    ({"/nav_vel": ["/estimator"], "/cmd_vel": ["/teleop"]}, {"/cmd_vel": [ME]}),
    ({"/lane/error": ["/lane"]}, {"/arm/joint_controller/command": [ME]}),
    ({"/cmd_vel": ["/turtle"]}, {})])
def test_what_is_heard_or_is_none_of_ours_is_no_fault(publishers, subscribers):
    assert not lines(unheard(graph(publishers, subscribers), ME))


def test_a_camera_that_nobody_has_by_that_name():
    line, = lines(unseen(graph({CAMERA: [ME]}, {"/camera/image_raw": ["/follower"]}), ME))
    assert line == ("/follower waits for sensor_msgs/Image on /camera/image_raw, but nobody "
                    f"publishes it; the simulator publishes {CAMERA}")


@pytest.mark.parametrize("publishers, subscribers", [
    ({CAMERA: [ME]}, {CAMERA: ["/follower"]}),
    ({CAMERA: [ME]}, {"/detections/image": ["/rviz_123"]}),
    ({CAMERA: [ME]}, {"/camera/image": [ME]}),
    ({CAMERA: ["/usb_cam"]}, {"/camera/image": ["/follower"]}),
    ({CAMERA: [ME], "/small/image": ["/resizer"]}, {"/small/image": ["/follower"]})])
def test_images_that_come_or_are_none_of_ours_are_no_fault(publishers, subscribers):
    assert not lines(unseen(graph(publishers, subscribers), ME))


def test_who_sends_a_type_that_is_not_taken_is_named_and_no_publisher():
    types = {ME: {"/cmd_vel": TWIST, "/any": "*"},
             "/pub": {"/cmd_vel": "std_msgs/String", "/any": FLOAT, "/free": FLOAT},
             "/relay": {"/cmd_vel": "*"}, "/follower": {"/cmd_vel": TWIST}}
    found = typed(
        Graph({"/cmd_vel": ["/follower", "/pub", "/relay", "/hangs"], "/any": ["/pub"],
               "/free": ["/pub"]},
              {"/cmd_vel": [ME], "/any": [ME], "/free": ["/other"]},
              {"/cmd_vel": "std_msgs/String", "/any": FLOAT, "/free": FLOAT}),
        ME, lambda node, _call: types.get(node, {}))
    assert lines(mistyped(found)) == [
        f"/pub sends std_msgs/String on /cmd_vel, which takes {TWIST}, so none of it arrives: end "
        f"it, and send {TWIST}"]
    assert found.publishers == {"/cmd_vel": ["/follower", "/relay", "/hangs"], "/any": ["/pub"],
                                "/free": ["/pub"]}
    assert found.types["/cmd_vel"] == TWIST


def test_a_robot_without_another_driver_is_still_idle():
    found = typed(Graph({"/cmd_vel": ["/pub"], "/nav_vel": ["/planner"]}, {"/cmd_vel": [ME]},
                        {"/cmd_vel": "std_msgs/String", "/nav_vel": TWIST}), ME,
                  lambda node, _call: {"/cmd_vel": TWIST if node == ME else "std_msgs/String"})
    assert lines(unheard(found, ME))[0].startswith("/planner sends commands on /nav_vel, but")


def test_a_fault_is_said_once_after_a_while_and_again_only_much_later():
    reports, fault = Reports(), Fault("it", "%s", (1,))
    assert not reports.due([fault], 0.0)
    assert not reports.due([fault], PATIENCE - 0.1)
    assert reports.due([fault], PATIENCE) == [fault]
    lasting = PATIENCE + 10 * AGAIN
    for now in range(int(PATIENCE), int(lasting)):
        assert not reports.due([fault], now)
    assert not reports.due([], lasting)
    assert not reports.due([fault], lasting + 1)
    assert not reports.due([fault], lasting + 1 + PATIENCE)  # it flickers
    reports.due([], lasting + 2 + PATIENCE)
    later = lasting + PATIENCE + 2 * AGAIN
    assert not reports.due([fault], later)
    assert reports.due([fault], later + PATIENCE) == [fault]


def test_a_master_that_ends_within_an_answer_does_not_end_the_watch(monkeypatch):
    at_shutdown, looks = [], []

    def look(_master, _last):
        looks.append(len(looks))
        if len(looks) > 1:
            at_shutdown[0]()
        raise IncompleteRead(b"")

    monkeypatch.setattr(rospy, "on_shutdown", at_shutdown.append)
    monkeypatch.setattr(topic_faults, "LOOK", 0.0)
    monkeypatch.setattr(topic_faults, "_graph", look)
    topic_faults._watch(Senders())
    assert looks == [0, 1]


def test_types_are_asked_for_when_the_graph_has_changed():
    asked, state = [], [[["/cmd_vel", ["/a"]]], [], []]
    master = SimpleNamespace(getSystemState=lambda: state,
                             getTopicTypes=lambda: asked.append(1) or [["/cmd_vel", TWIST]])
    first = topic_faults._graph(master, Graph({}, {}, {}))
    assert topic_faults._graph(master, first) is first and len(asked) == 1
    assert first == Graph({"/cmd_vel": ["/a"]}, {}, {"/cmd_vel": TWIST})
    state[1] = [["/cmd_vel", [ME]]]
    assert topic_faults._graph(master, first).subscribers == {"/cmd_vel": [ME]} and len(asked) == 2
