"""Driving without ROS: the thread that stops, and what the operations refuse."""

import asyncio
import time

import pytest
from sim_viewer import drive, drive_guard, registry
from sim_viewer.drive_guard import HOLD, STOP, Command, Handles
from sim_viewer.options import Options
from sim_viewer.registry import Context, Node, Refused

AHEAD = Command(0.2, 0.0)


class Robot:
    """What was published, with its time."""

    def __init__(self):
        self.sent = []

    def publish(self, topic, command):
        self.sent.append((time.monotonic(), topic, command))

    def commands(self, topic="/cmd_vel"):
        return [command for _, name, command in self.sent if name == topic]

    def wait_for(self, count):
        end = time.monotonic() + 60.0
        while len(self.sent) < count and time.monotonic() < end:
            time.sleep(0.005)


@pytest.fixture
def robot():
    return Robot()


@pytest.fixture
def handles(robot):
    made = Handles(robot.publish)
    yield made
    made.close()


def test_the_thread_stops_a_robot_of_which_nothing_is_heard(handles, robot):
    handles.press(1, "/cmd_vel", AHEAD)
    robot.wait_for(2)
    assert robot.commands() == [AHEAD, STOP]
    assert HOLD <= robot.sent[1][0] - robot.sent[0][0] < HOLD + 15.0  # a busy machine
    time.sleep(HOLD)
    assert len(robot.sent) == 2


def test_each_robot_has_its_own_driver(handles, robot):
    handles.press(1, "/one/cmd_vel", AHEAD)
    handles.press(2, "/two/cmd_vel", AHEAD)
    handles.release(1)
    assert robot.commands("/one/cmd_vel") == [AHEAD, STOP]
    assert robot.commands("/two/cmd_vel") == [AHEAD]


def test_who_turns_to_another_robot_stops_the_first(handles, robot):
    handles.press(1, "/one/cmd_vel", AHEAD)
    handles.press(1, "/two/cmd_vel", AHEAD)
    assert robot.commands("/one/cmd_vel") == [AHEAD, STOP]


def test_the_end_of_the_node_stops_everything(robot):
    handles = Handles(robot.publish)
    handles.press(1, "/cmd_vel", AHEAD)
    handles.close()
    assert robot.commands() == [AHEAD, STOP]


def test_messages():
    turn = drive_guard.twist(Command(0.2, -1.0))
    assert (turn.linear.x, turn.linear.y, turn.angular.z) == (0.2, 0.0, -1.0)


@pytest.fixture
def ask(monkeypatch):
    """An operation as a browser asks for it, on a master that knows one robot and one camera."""
    monkeypatch.setattr(drive, "driven_topics", lambda: {"/cmd_vel": "geometry_msgs/Twist"})

    def run(name, **args):
        async def story():
            node = Node(Options(control=True), asyncio.get_running_loop())
            try:
                found = registry.find_operation(name)
                return await found.function(Context(node, 1), **found.arguments(args))
            finally:
                node.close()
        return asyncio.run(story())
    return run


def test_topics_that_can_be_driven(ask):
    assert ask("drive_topics") == [{"topic": "/cmd_vel", "type": "geometry_msgs/Twist"}]


@pytest.mark.parametrize(("args", "reason"), [
    ({"linear": "fast", "angular": 0}, "linear"),
    ({"linear": 1.0}, "angular"),
    ({"linear": float("inf"), "angular": 0}, "linear"),
    ({"linear": True, "angular": 0}, "linear"),
    ({"linear": 21, "angular": 0}, "more than 20"),
    ({"linear": 0, "angular": -1e9}, "more than 20"),
    ({"linear": 0.1, "angular": 0, "topic": "/scan"}, "no robot listens to /scan; there is /cmd"),
    ({"linear": 0.1, "angular": 0, "topic": "a b"}, "not the name of a topic"),
    ({"linear": 0.1, "angular": 0, "topic": "/" + "a" * 5000}, "not the name of a topic"),
    ({"linear": 0.1, "angular": 0, "wheels": 3}, "wheels"),
])
def test_what_is_no_command_is_refused_with_its_reason(ask, args, reason):
    with pytest.raises(Refused, match=reason):
        ask("drive", **args)


def test_all_that_drives_needs_control():
    for name in ("drive", "drive_open", "drive_release"):
        assert registry.find_operation(name).control
