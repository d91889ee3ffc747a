"""Driving without ROS: the thread that stops, what is refused, and the dead man's handle."""

import asyncio
import itertools
import random
import time

import pytest
from sim_viewer import drive, drive_guard, registry
from sim_viewer.drive_guard import HOLD, STOP, Command, DeadMan, DrivenByAnother, Handles
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
    pressed = time.monotonic()
    handles.press(1, "/cmd_vel", AHEAD)
    robot.wait_for(2)
    assert robot.commands() == [AHEAD, STOP]
    assert HOLD <= robot.sent[1][0] - pressed < HOLD + 15.0  # a busy machine
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


LEFT = Command(0.0, 1.0)
PERIOD = 0.1  # s between messages of a held key


@pytest.fixture
def handle():
    return DeadMan()


def test_a_held_key_is_passed_on_message_by_message(handle):
    assert [handle.press("ann", AHEAD, tick * PERIOD) for tick in range(5)] == [[AHEAD]] * 5


def test_a_released_key_stops_once(handle):
    handle.press("ann", AHEAD, 0.0)
    assert handle.release("ann") == [STOP]
    assert handle.release("ann") == []
    assert handle.expire(10.0) == []


def test_silence_stops_once_and_within_the_limit(handle):
    handle.press("ann", AHEAD, 1.0)
    assert handle.expire(1.0 + HOLD - 0.01) == []
    assert handle.until == 1.0 + HOLD <= 1.3
    assert handle.expire(handle.until) == [STOP]
    assert handle.expire(5.0) == []
    assert handle.driver is None


def test_after_silence_the_stop_comes_before_the_next_command(handle):
    handle.press("ann", AHEAD, 0.0)
    assert handle.press("ann", AHEAD, 2.0) == [STOP, AHEAD]


def test_a_second_driver_stops_first_and_then_drives(handle):
    handle.press("ann", AHEAD, 0.0)
    assert handle.press("bob", LEFT, 0.1) == [STOP]
    assert handle.driver == "bob"
    assert handle.press("bob", LEFT, 0.2) == [LEFT]


def test_the_first_driver_must_let_go_before_it_drives_again(handle):
    handle.press("ann", AHEAD, 0.0)
    handle.press("bob", LEFT, 0.1)
    for tick in range(2, 8):
        with pytest.raises(DrivenByAnother):
            handle.press("ann", AHEAD, tick * PERIOD)
    assert handle.release("ann") == []
    assert handle.press("ann", AHEAD, 0.8) == [AHEAD]


def test_who_still_presses_does_not_get_the_handle_when_the_other_lets_go(handle):
    handle.press("ann", AHEAD, 0.0)
    handle.press("bob", LEFT, 0.1)
    handle.release("bob")
    with pytest.raises(DrivenByAnother):
        handle.press("ann", AHEAD, 0.2)
    with pytest.raises(DrivenByAnother):
        handle.press("ann", AHEAD, 0.2 + 2 * HOLD)


def test_a_driver_that_stuttered_does_not_take_the_handle_back(handle):
    handle.press("ann", AHEAD, 0.0)
    assert handle.expire(HOLD) == [STOP]
    assert handle.press("bob", LEFT, 0.3) == [LEFT]
    with pytest.raises(DrivenByAnother):
        handle.press("ann", AHEAD, 0.4)
    assert handle.driver == "bob"
    handle.release("ann")
    assert handle.press("ann", AHEAD, 0.5) == [STOP]


def test_a_driver_that_stuttered_drives_on_if_nobody_else_has(handle):
    handle.press("ann", AHEAD, 0.0)
    assert handle.expire(HOLD) == [STOP]
    assert handle.press("ann", AHEAD, 0.4) == [AHEAD]


def test_who_stuttered_and_released_is_not_waited_for(handle):
    handle.press("ann", AHEAD, 0.0)
    handle.expire(HOLD)
    handle.release("ann")
    handle.press("bob", LEFT, 0.3)
    assert handle.press("ann", AHEAD, 0.4) == [STOP]


def test_another_ones_release_stops_nobody(handle):
    handle.press("ann", AHEAD, 0.0)
    assert handle.release("bob") == []
    assert handle.driver == "ann"


@pytest.mark.parametrize("seed", range(20))
def test_whatever_comes_nothing_moves_for_longer_than_a_command(seed):
    """Every motion is followed by a stop or a newer command of the same client in time."""
    chance, handle, now = random.Random(seed), DeadMan(), 0.0
    sent: list[tuple[float, Command]] = []
    for _ in range(300):
        step = chance.choice([0.01, PERIOD, PERIOD, 0.4])
        due = handle.until
        if due <= now + step:  # as the timer of the server does
            sent += [(due, command) for command in handle.expire(due)]
        now += step
        client = chance.choice("abc")
        try:
            pressed = chance.random() < 0.8
            new = handle.press(client, AHEAD, now) if pressed else handle.release(client)
        except DrivenByAnother:
            new = []
        sent += [(now, command) for command in new]
    due = handle.until
    sent += [(due, command) for command in handle.expire(due)]
    for (then, command), (later, following) in itertools.pairwise(sent):
        assert command == STOP or later - then <= HOLD + 1e-6
        assert not command == following == STOP
    assert sent[-1][1] == STOP
