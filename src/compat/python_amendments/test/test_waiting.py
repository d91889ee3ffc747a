"""A node says once what it waits for; connections and the master's answers are this test's own."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import urlsplit

import pytest
import rosgraph
import rospy
from python_amendments import waiting
from roslib.packages import find_node

LIMIT = 60.0  # s
SRC = Path(__file__).resolve().parents[3]
IMAGE, TOPIC = "sensor_msgs/Image", "/camera/rgb/image_raw"


def address(server):
    return f"http://127.0.0.1:{server.getsockname()[1]}/"


@pytest.fixture
def gone():
    """A URI where nobody listens any more."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        uri = address(server)
    return uri


@pytest.fixture
def asked(monkeypatch):
    """Closes a connection of a subscriber; what was looked into then: topics and publishers."""
    found = []
    monkeypatch.setattr(waiting, "WATCH_THEMSELVES", {"nav_nodes"})
    monkeypatch.delitem(sys.modules, "nav_nodes", raising=False)  # of other tests
    monkeypatch.setattr(waiting, "GRACE", 0.0)
    monkeypatch.setattr(waiting, "tell", lambda *what: found.append(what))

    monkeypatch.setattr(waiting, "after_grace", lambda *_: None)

    class Subscriber:
        def __init__(self, kind, closed):
            self.type, self.closed, self.resolved_name = kind, closed, TOPIC
            self.receive_callback = None

        def remove_connection(self, connection):
            connection.removed = True

    waiting.amend_topics(SimpleNamespace(_SubscriberImpl=Subscriber))

    def close(kind=IMAGE, publisher="/gazebo", uri="http://a:1/", closed=False):
        connection = SimpleNamespace(callerid_pub=publisher, endpoint_id=uri, removed=False)
        Subscriber(kind, closed).remove_connection(connection)
        assert connection.removed
        for thread in threading.enumerate():
            if isinstance(thread, threading.Timer):
                thread.join(LIMIT)
        return found

    return close


def test_a_program_that_watches_its_topics_itself_says_no_more(asked, monkeypatch):
    monkeypatch.setitem(sys.modules, "nav_nodes", SimpleNamespace())
    assert asked() == []


def test_once_for_each_simulator(asked):
    asked()
    asked(kind="sensor_msgs/LaserScan")
    assert asked(publisher="/two/gazebo", uri="http://a:2/") == [
        (TOPIC, "http://a:1/"), (TOPIC, "http://a:2/")]


@pytest.mark.parametrize("other", [
    {"closed": True}, {"publisher": "/camera_driver"}, {"kind": "rosgraph_msgs/Clock"}])
def test_other_ends_are_not_the_simulators(asked, other):
    assert asked(**other) == []


def test_a_simulator_that_runs_on_has_not_ended(said):
    with socket.create_server(("127.0.0.1", 0)) as running:  # a model was deleted
        waiting.tell(TOPIC, address(running))
    assert said == []


def test_a_node_that_ends_too_says_nothing(said, gone, monkeypatch):
    monkeypatch.setattr(rospy, "is_shutdown", lambda: True)
    waiting.tell(TOPIC, gone)
    assert said == []


def test_what_to_do_depends_on_the_master(said, gone, monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as master:
        uri = address(master)
        monkeypatch.setattr(rosgraph, "get_master_uri", lambda: uri)
        waiting.tell(TOPIC, gone)
    waiting.tell(TOPIC, gone)
    assert said == [
        f"The simulator has ended: no more messages on {TOPIC}. When the course is started again, "
        "this program goes on by itself.",
        f"The simulator and the ROS master have ended: no more messages on {TOPIC}. Press Ctrl-C; "
        "start the course, then this program again."]


SIMULATED = {"/camera/rgb/image_raw": ("sensor_msgs/Image", ["/gazebo"]),
             "/camera/depth/image_raw": ("sensor_msgs/Image", ["/two/gazebo"]),
             "/scan": ("sensor_msgs/LaserScan", ["/gazebo"]),
             "/follower/picture": ("sensor_msgs/Image", ["/follower"])}


@pytest.fixture
def master(monkeypatch):
    """What the master knows: topics and services, which a test may change."""
    state = SimpleNamespace(topics=dict(SIMULATED), services=["/spawn", "/clear"])
    answers = {"getPublishedTopics": lambda: [[name, kind] for name, (kind, _) in
                                              state.topics.items()],
               "getSystemState": lambda: [[[name, nodes] for name, (_, nodes) in
                                           state.topics.items()], [],
                                          [[name, ["/turtlesim"]] for name in state.services]]}
    monkeypatch.setattr(waiting, "asked", lambda call, *_: answers[call]())
    return state


def test_why_no_image_comes(said, master):
    waiting.tell_of_silence("/camera/image_raw", IMAGE)
    waiting.tell_of_silence("/base_scan", "sensor_msgs/CompressedImage")
    waiting.tell_of_silence("/follower/picture", IMAGE)  # no simulator's: perhaps it has none yet
    waiting.tell_of_silence(TOPIC, IMAGE)
    master.topics = {"/follower/picture": SIMULATED["/follower/picture"]}
    waiting.tell_of_silence("/camera/image_raw", IMAGE)
    waiting.tell_of_silence(TOPIC, IMAGE)  # once for all topics
    assert said == [
        "Nothing on /camera/image_raw yet: nobody publishes it. If /camera/rgb/image_raw is meant, "
        "end this program and start it with /camera/image_raw:=/camera/rgb/image_raw.",
        "Nothing on /base_scan yet: no robot of the simulator that runs has such a sensor.",
        f"Nothing on {TOPIC} yet, though it is published: is the simulation paused?",
        "Nothing on /camera/image_raw yet: nobody publishes it, and no simulator runs. Start the "
        "course in another terminal: roslaunch racecar_description car_control.launch; this "
        "program then goes on by itself."]


def test_why_no_pose_of_a_turtle_comes(said, master):
    kind = "turtlesim/Pose"
    waiting.tell_of_silence("/turtle1/pose", kind)
    master.topics["/turtle1/pose"] = kind, ["/turtlesim"]
    for name in ("/turtle9/pose", "/turtle1/pose", "/pose"):
        waiting.tell_of_silence(name, kind)
    assert said == [
        "Nothing on /turtle1/pose yet: nobody publishes it. Type in another terminal: rosrun "
        "turtlesim turtlesim_node; this program then goes on by itself.",
        "Nothing on /turtle9/pose yet: there is no turtle turtle9. Type in another terminal: "
        "rosservice call /spawn 2 2 0 turtle9; this program then goes on by itself.",
        "Nothing on /pose yet: nobody publishes it. If /turtle1/pose is meant, end this program "
        "and start it with /pose:=/turtle1/pose."]


def test_the_first_programs_wait_for_a_known_publisher(said, master):
    waiting.tell_of_silence("/person_info", "learning_topic/Person")
    master.topics["/chatter"] = "std_msgs/String", ["/talker"]
    waiting.tell_of_silence("/chatter", "std_msgs/String")
    assert said == ["Nothing on /person_info yet: nobody publishes it. Type in another terminal: "
                    "rosrun learning_topic person_publisher.py; this program then goes on by "
                    "itself."]


@pytest.mark.parametrize(("program", "topic", "typed"), [
    ("learning_topic/scripts/01follower.py", TOPIC, "learning_topic 0course.launch"),
    ("car_control/scripts/lane_follow.py", "", "racecar_description car_control.launch"),
    ("lessons/lane_keeping/scripts/learning_node.py", "", "lane_keeping lane.launch"),
    ("mine.py", "/camera", "lane_keeping lane.launch"),
    ("mine.py", "/scan", "learning_topic 0course.launch")])
def test_the_course_of_a_program(monkeypatch, program, topic, typed):
    monkeypatch.setattr(sys, "argv", [str(SRC / program)])
    assert waiting.course(topic) == f"roslaunch {typed}"


@pytest.mark.parametrize(("program", "line"), [
    ("turtlesim/nodes/turtle_teleop_key", "Type roscore in another terminal, and rosrun turtlesim "
     "turtlesim_node in a third one; this program"),
    ("compat/turtlesim/nodes/turtlesim_node", "Type roscore in another terminal; this program"),
    ("rospy_tutorials/001_talker_listener/listener", "Type roscore in another terminal; this"),
    ("learning_topic/scripts/01follower.py", "Type roscore in another terminal, or start the")])
def test_without_a_master_only_what_the_program_needs_is_named(monkeypatch, program, line):
    monkeypatch.setattr(sys, "argv", [str(SRC / program)])
    assert waiting.no_master("URI", "roscore").startswith(f"No ROS master at URI. {line}")


@pytest.mark.parametrize("command", [*waiting.COURSES.values(), waiting.LINE_COURSE])
def test_each_course_has_its_launch_file(command):
    _, package, file, *_ = command.split()
    assert list(SRC.glob(f"**/{package}/launch/{file}"))


def test_a_service_that_nobody_offers(said, master):
    for name in ("/spawn", "/spwan", "/gazebo/pause_physics", "/show_person"):
        waiting.tell_of_service(name)
    assert said == ["Nobody offers the service /spwan yet; is /spawn meant?",
                    "Nobody offers the service /gazebo/pause_physics yet: start the program that "
                    "does in another terminal; this one then goes on by itself.",
                    "Nobody offers the service /show_person yet. Type in another terminal: rosrun "
                    "learning_service person_server.py; this program then goes on by itself."]


def test_an_action_that_nobody_offers(said, master):
    master.topics["/there/status"] = "actionlib_msgs/GoalStatusArray", ["/server"]
    for name in ("there", "addInts", "mine"):
        waiting.tell_of_action(name)
    assert said == ["Nobody offers the action /addInts yet. Type in another terminal: rosrun "
                    "learning_action action01_server.py; this program then goes on by itself.",
                    "Nobody offers the action /mine yet: start the program that does in another "
                    "terminal; this one then goes on by itself."]


def test_each_frame_that_nobody_publishes_is_told_once(said, monkeypatch):
    looks = []
    monkeypatch.setattr(waiting, "WATCH_THEMSELVES", set())
    monkeypatch.setattr(waiting, "after_grace", lambda *what: looks.append(what))

    class Buffer:
        def _frameExists(self, frame):
            return frame == "world"

        def lookup_transform(self, *words):
            return words

    waiting.amend_frames(SimpleNamespace(Buffer=Buffer))
    for words in (("turtle2", "turtle1", 0), ("turtle2", "turtle1", 0), ("world", "hand", 0),
                  ("map", "radar", 0)):
        assert Buffer().lookup_transform(*words) == words
    for look, *words in looks:
        look(*words)
    assert said == [
        *(f"Nobody publishes the frame turtle{n} yet. Type in another terminal: rosrun learning_tf "
          f"demo04_pub.py turtle{n}; this program then goes on by itself." for n in (1, 2)),
        "Nobody publishes the frame hand yet: start the program that does in another terminal; "
        "this one then goes on by itself.",
        "Nobody publishes the frame radar yet. Type in another terminal: rosrun learning_tf "
        "static_tf_pub.py; this program then goes on by itself."]


@pytest.mark.parametrize("command", waiting.STARTED_BY.values())
def test_what_is_to_be_started_is_there(command):
    assert find_node(*command.split()[1:3])


@pytest.mark.parametrize("seconds", [0, 1])
def test_the_server_of_an_action_is_waited_for_as_actionlib_does(monkeypatch, seconds):
    told, kind = [], type("ActionClient", (), {"ns": "addInts", "wait_for_server":
                                               lambda _, *timeout: timeout})
    waiting.amend_actions(SimpleNamespace(ActionClient=kind, rospy=rospy))
    monkeypatch.setattr(waiting, "after_grace", lambda act, name: told.append((act, name)) or
                        SimpleNamespace(cancel=lambda: told.append("cancelled")))
    timeout = rospy.Duration(seconds)
    assert kind().wait_for_server(timeout) == ((timeout,) if seconds else ())
    assert told == ([] if seconds else [(waiting.tell_of_action, "addInts"), "cancelled"])


def test_a_service_is_waited_for_as_rospy_does(monkeypatch):
    waits, told = [], []
    services = SimpleNamespace(wait_for_service=lambda *words: waits.append(words))
    waiting.amend_services(services)
    monkeypatch.setattr(waiting, "later", lambda _, act, name: told.append((act, name)) or
                        SimpleNamespace(cancel=lambda: told.append("cancelled")))
    services.wait_for_service("/spawn", 0.5)
    assert (waits, told) == ([("/spawn", 0.5)], [])
    services.wait_for_service("/spawn")
    assert waits[1:] == [("/spawn",)]
    assert told == [(waiting.tell_of_service, "/spawn"), "cancelled"]


def test_nodes_of_a_launch_wait_longer(monkeypatch):
    begun = []
    monkeypatch.setattr(waiting, "later", lambda seconds, *_: begun.append(seconds))
    for words in (["follower.py"], ["follower.py", "__name:=a", "__log:=/a.log"]):
        monkeypatch.setattr(sys, "argv", words)
        waiting.after_grace(None)
    assert begun == [waiting.GRACE, waiting.LAUNCH_GRACE]


@pytest.fixture
def subscribe(monkeypatch):
    """Makes a subscriber; `looks` are the timers that it starts, `told` the silent topics."""
    class Subscriber:
        closed = False

        def __init__(self, name, kind):
            self.resolved_name, self.type = name, kind

        def receive_callback(self, *what):
            self.received = what

        def remove_connection(self, connection):
            """As rospy's."""

    def make(name, kind="sensor_msgs/LaserScan"):
        return Subscriber(name, kind)

    make.looks, make.told = [], []
    monkeypatch.setattr(waiting, "WATCH_THEMSELVES", set())
    monkeypatch.setattr(waiting, "later", lambda _, look, name: make.looks.append(
        lambda: look(name)))
    monkeypatch.setattr(waiting, "tell_of_silence", lambda *what: make.told.append(what))
    waiting.amend_topics(SimpleNamespace(_SubscriberImpl=Subscriber))
    return make


def test_a_topic_that_was_heard_is_not_missed(subscribe):
    heard = subscribe("/scan")
    heard.receive_callback("message", "connection")
    heard.closed = True  # its publisher has ended, too
    subscribe("/scan")
    subscribe("/mine", "std_msgs/String")
    assert heard.received == ("message", "connection") and len(subscribe.looks) == 1
    subscribe.looks[0]()
    assert subscribe.told == []
    subscribe("/turtle9/pose", "turtlesim/Pose")
    subscribe("/chatter", "std_msgs/String")
    assert len(subscribe.looks) == 3


def test_waiting_in_a_loop_starts_one_timer_and_is_told(subscribe):
    for _ in range(3):
        newest = subscribe("/scan")
    newest.closed = True  # between two rounds
    subscribe.looks[0]()
    assert subscribe.told == []
    subscribe("/scan")
    subscribe.looks[1]()
    assert len(subscribe.looks) == 2 and subscribe.told == [("/scan", "sensor_msgs/LaserScan")]


def node(words, **environment):
    source = str(Path(waiting.__file__).parents[1])
    return subprocess.Popen(
        [sys.executable, "-c", words], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": f"{source}:{os.environ['PYTHONPATH']}"} | environment)


@pytest.mark.parametrize(("language", "line"), [
    ("en", "No ROS master at {0}. Type {1} in another terminal, or start the course there: "
           "roslaunch learning_topic 0course.launch; this program then goes on by itself.\n"),
    ("zh_CN", "{0} 上没有 ROS master。请在另一个终端里输入 {1}，或在那里启动跑道："
              "roslaunch learning_topic 0course.launch；这个程序会自己继续。\n")])
def test_without_a_master_a_line_and_ctrl_c_ends_it_at_once(gone, language, line):
    waits = node("import rospy; rospy.init_node('lesson')", ROS_MASTER_URI=gone,
                 LC_ALL="C.UTF-8", LANGUAGE=language)
    assert waits.stderr.readline() == line.format(gone, f"roscore -p {urlsplit(gone).port}")
    waits.send_signal(signal.SIGINT)
    assert waits.communicate(timeout=3.0) == ("", "")  # rospy alone takes 5 s
    assert waits.returncode == 128 + signal.SIGINT


def test_ctrl_c_while_it_registers_is_no_traceback():
    with socket.create_server(("127.0.0.1", 0)) as no_master:
        def hang_up():
            with contextlib.suppress(OSError):
                while True:
                    no_master.accept()[0].close()

        threading.Thread(target=hang_up, daemon=True).start()
        registers = node("import rospy; rospy.init_node('lesson')",
                         PYTHONUNBUFFERED="1", ROS_MASTER_URI=address(no_master))
        assert "Unable to register with master" in registers.stdout.readline()
        registers.send_signal(signal.SIGINT)
        assert "Traceback" not in registers.communicate(timeout=LIMIT)[1]
        assert registers.returncode == 128 + signal.SIGINT


@pytest.mark.parametrize("uri", ["localhost:11311", "http://localhost:99999", "http://localhost:0",
                                 "http://localhost"])
def test_a_wrong_address_of_the_master_ends_it_with_a_line(uri):
    ends = node("import rospy; rospy.init_node('lesson')", ROS_MASTER_URI=uri)
    assert ends.communicate(timeout=LIMIT)[1] == (
        f"ROS_MASTER_URI is {uri}, and must be as http://localhost:11311\n")
    assert ends.returncode == 1


def test_a_master_with_an_address_of_ipv6_is_waited_for():
    waits = node("import rospy; rospy.init_node('lesson')", ROS_MASTER_URI="http://[::1]:9")
    said = waits.stderr.readline()
    waits.kill()
    waits.communicate()
    assert said.startswith("No ROS master at http://[::1]:9. Type roscore -p 9 in")


def test_at_pythons_prompt_ctrl_c_is_the_prompts(gone):
    typed = ("import rospy, sys\nsys.ps1 = '>>> '\ntry: rospy.init_node('a')\n"
             "except KeyboardInterrupt: print('still here')\n")
    waits = node(typed, ROS_MASTER_URI=gone)
    assert gone in waits.stderr.readline()
    waits.send_signal(signal.SIGINT)
    assert waits.communicate(timeout=LIMIT)[0] == "still here\n"


def test_every_python_node_has_it():
    done = node("import rospy; print(rospy.topics._SubscriberImpl.remove_connection.__module__, "
                "rospy.init_node.__module__, rospy.wait_for_service.__module__)")
    assert done.communicate(timeout=LIMIT) == (" ".join([waiting.__name__] * 3) + "\n", "")
