"""Programs that are run as nodes, on a ROS master of their own; this process is another node."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from xmlrpc.client import ServerProxy

import actionlib
import rosgraph
import rospy
import tf2_geometry_msgs  # noqa: F401  teaches tf2 to transform a PointStamped
import tf2_ros
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PointStamped, Twist
from learning_action.msg import AddIntsAction, AddIntsGoal
from std_srvs.srv import SetBool
from turtlesim.msg import Pose

from exercises.finding import Finding, Mistake, holds, near
from exercises.program import compiled
from run_session.launch import Launched, describe_exit
from run_session.processes import Child, Family

START = 20.0  # s, wall: for the node's first topic or service
PAUSE = 0.05  # s
ALONG = 5.5  # m, x of its start, and its y


@contextlib.contextmanager
def running(file: Path) -> Iterator[Callable[[Callable[[], object], float], bool]]:
    """While the node runs: a function that waits (at most s) for a condition; True if it holds.

    CannotCheck if it is no Python, RunError if no roscore starts; the function raises Mistake if
    the node has ended.
    """
    compiled(file)
    with tempfile.TemporaryDirectory() as folder, Family() as family:
        launched = Launched(family, Path(folder) / "log")
        launched.start_roscore()
        rospy.init_node("check_exercise", disable_signals=True, disable_rosout=True)
        child = launched.start("exercise", [sys.executable, str(file)])
        try:
            yield lambda condition, limit: wait(file, child, condition, limit)
        finally:
            rospy.signal_shutdown("checked")


def wait(file: Path, child: Child, condition: Callable[[], object], limit: float) -> bool:
    """Whether the condition holds within `limit`, s, wall; Mistake if the node ends before."""
    end = time.monotonic() + limit
    while not (holds := bool(condition())) and time.monotonic() < end:
        code = child.process.poll()
        if code is not None:
            last = child.last_lines(1).strip() or "it said nothing"
            raise Mistake(f"{file}: ended, {describe_exit(code)}: {last}")
        time.sleep(PAUSE)
    return holds


class Turtle:
    """A turtle that drives along x with the last command."""

    def __init__(self) -> None:
        self.x, self.speed, self.commands = ALONG, 0.0, 0
        self._poses = rospy.Publisher("/turtle1/pose", Pose, queue_size=1)
        rospy.Subscriber("/turtle1/cmd_vel", Twist, self._take, queue_size=1)

    def _take(self, command: Twist) -> None:
        self.speed, self.commands = command.linear.x, self.commands + 1

    def live(self) -> bool:
        """Advance by one step and publish the pose; returns whether any command has come."""
        self.x += PAUSE * self.speed
        self._poses.publish(Pose(x=self.x, y=ALONG, linear_velocity=self.speed))
        return self.commands > 0


def wall(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A node that stops a (simulated) turtle: from /turtle1/pose to /turtle1/cmd_vel.

    It must set off, and stop before the wall.
    """
    with running(file) as until:
        turtle = Turtle()
        commanded = until(turtle.live, START)
        yield holds("commands on /turtle1/cmd_vel", str(turtle.commands), "1 or more", commanded)
        until(lambda: turtle.live() and False, limits["seconds"])
        middle = (limits["least_x"] + limits["most_x"]) / 2
        yield near("x at the end", turtle.x, middle, limits["most_x"] - middle, " m")
        yield near("speed at the end", turtle.speed, 0.0, 0.05, " m/s")


ENDING_TOPIC = "/turtle1/cmd_vel"


def ending(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The last command of a node that is ended by Ctrl-C.

    The turtle must drive, and stop after Ctrl-C.
    """
    with running(file) as until:
        commands: list[Twist] = []
        rospy.Subscriber(ENDING_TOPIC, Twist, commands.append, queue_size=10)
        drives = until(lambda: any(command.linear.x for command in commands), START)
        yield holds("the turtle", "drives" if drives else "stands", "drives", drives)
        if not commands:
            raise Mistake(f"{file}: publishes nothing on {ENDING_TOPIC}")
        try:
            os.kill(_process(commands[0]._connection_header["callerid"]), signal.SIGINT)
        except (rosgraph.MasterError, OSError):  # it is just ending by itself
            until(lambda: False, START)
        time.sleep(limits["seconds"])
        last = commands[-1].linear.x, commands[-1].angular.z
        yield holds("the last command after Ctrl-C", f"{last[0]:g} m/s, {last[1]:g} rad/s",
                    "0 m/s, 0 rad/s", last == (0.0, 0.0))


def _process(node: str) -> int:
    caller = rospy.get_name()
    return ServerProxy(rosgraph.Master(caller).lookupNode(node)).getPid(caller)[2]


SERVICE, SWITCH_TOPIC = "/turtle_drive", "/turtle1/cmd_vel"
QUIET = 0.5  # s, by which messages sent before a call have arrived
PATIENCE = 5.0  # s, for the first command after it was switched on


def switch(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A service that starts and stops the turtle: /turtle_drive, std_srvs/SetBool.

    true: it must drive; true again: still drive; false: stop, and stay so.
    """
    with running(file) as until:
        speeds: list[float] = []
        rospy.Subscriber(SWITCH_TOPIC, Twist, lambda msg: speeds.append(msg.linear.x),
                         queue_size=10)
        if not until(_is_there, START):
            raise Mistake(f"{file}: offers no service {SERVICE} of type std_srvs/SetBool")
        set_drive = rospy.ServiceProxy(SERVICE, SetBool)
        for wanted in (True, True, False, False):
            try:
                success = set_drive(wanted).success
            except rospy.ServiceException as error:
                raise Mistake(f"{file}: {SERVICE} failed: {error}") from error
            until(lambda: False, QUIET)
            speeds.clear()
            drives = until(lambda: any(speeds), PATIENCE if wanted else limits["seconds"])
            yield holds(f"after {SERVICE} {str(wanted).lower()}", _words(drives), _words(wanted),
                        drives == wanted)
            yield holds(f"its answer to {str(wanted).lower()}", f"success {success}",
                        "success True", success)


def _is_there() -> bool:
    try:
        rospy.wait_for_service(SERVICE, timeout=0.1)
    except rospy.ROSException:
        return False
    return True


def _words(drives: bool) -> str:
    return "the turtle drives" if drives else "the turtle stands"


PARAMETER_TOPIC, PARAMETER_NAME = "/turtle1/cmd_vel", "speed"
TOLERANCE = 0.001  # m/s


def parameter(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A private parameter that may change at any time: `speed` of a node that drives a turtle.

    Its speed must be the default, then the value set while it drives, then the default again.
    """
    with running(file) as until:
        commands: list[Twist] = []
        rospy.Subscriber(PARAMETER_TOPIC, Twist, commands.append, queue_size=10)
        if not until(lambda: commands, START):
            raise Mistake(f"{file}: publishes nothing on {PARAMETER_TOPIC}")
        parameter = f"{commands[0]._connection_header['callerid']}/{PARAMETER_NAME}"

        def driven(when: str, wanted: float) -> Finding:
            until(lambda: abs(commands[-1].linear.x - wanted) < TOLERANCE, limits["seconds"])
            return near(f"commanded speed ({when})", commands[-1].linear.x, wanted, TOLERANCE,
                        " m/s")

        yield driven("before anybody has set it", limits["default"])
        rospy.set_param(parameter, limits["other"])
        yield driven(f"after rosparam set {parameter} {limits['other']:g}", limits["other"])
        rospy.delete_param(parameter)
        yield driven(f"after rosparam delete {parameter}", limits["default"])


ACTION_NAME = "addInts"
BESIDE = -3, -1, 0, 3  # test goals, relative to the least valid one


def action(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """An action server that aborts unsuitable goals: addInts, learning_action/AddInts.

    Goals that are too small must be aborted, all others succeed with their sum.
    """
    least = round(limits["least"])
    with running(file) as until:
        # Not SimpleActionClient: it misses a result that comes before its send_goal() has returned.
        client = actionlib.ActionClient(ACTION_NAME, AddIntsAction)
        if not until(lambda: client.wait_for_server(rospy.Duration(0.1)), START):
            raise Mistake(f"{file}: offers no action {ACTION_NAME} of type learning_action/AddInts")
        for number in (least + beside for beside in BESIDE):
            sent = client.send_goal(AddIntsGoal(num=number))
            ended = until(lambda handle=sent: handle.get_comm_state() == CommState.DONE,
                          limits["seconds"])
            state = GoalStatus.to_string(sent.get_goal_status()) if ended else "none"
            if number >= least:
                total = sum(range(1, number + 1))
                given = getattr(sent.get_result(), "result", None)
                yield holds(f"sum for the goal {number}", str(given), str(total), given == total)
            wanted = "SUCCEEDED" if number >= least else "ABORTED"
            yield holds(f"end of the goal {number}", state, wanted, state == wanted)


POINT = 10.0, 2.0, 3.0  # m, in the radar's frame


def radar(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A static transform, world -> radar, as published by the program.

    The radar's point must be at the right place in the world.
    """
    with running(file) as until:
        buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(buffer)
        there = until(lambda: buffer.can_transform("world", "radar", rospy.Time(0)), START)
        yield holds("the transform world -> radar", "there" if there else "missing", "there", there)
        if there:
            point = PointStamped()
            point.header.frame_id = "radar"
            point.point.x, point.point.y, point.point.z = POINT
            seen = buffer.transform(point, "world").point
            for axis in "xyz":
                yield near(f"{axis} of the point {POINT} in world", getattr(seen, axis),
                           limits[axis], limits["tolerance"], " m")
