"""What must not go wrong with it when something in move_base goes wrong; no master."""

import math
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import PoseStamped, Quaternion
from move_base_msgs.msg import MoveBaseGoal
from nav_msgs.msg import Odometry

from costmap_2d.sources import MessageAge
from move_base import goals, services
from move_base.base import Base
from move_base.node import MoveBase
from move_base.planning import Planning
from move_base.plugin import settings_from, table
from move_base.services import Services
from move_base.state_machine import Patience, State, StateMachine
from move_base.watch import Watch
from nav_algorithms.costmap.costs import LETHAL, Costmap

PATIENCE = settings_from(Patience, {entry.name: entry.default for entry in table("move_base")})


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    """ROS time without a node."""
    monkeypatch.setattr(rospy, "get_time", time.monotonic)
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time.from_sec(time.monotonic()))


@pytest.fixture
def lines(monkeypatch):
    """What is logged as a warning or an error."""
    found = []
    for name in ("logerr_throttle", "logwarn_throttle"):
        monkeypatch.setattr(rospy, name, lambda _period, text, *values: found.append(
            text % values if values else text))
    monkeypatch.setattr(rospy, "logerr", lambda text, *values: found.append(text % values))
    return found


def pose(x=1.0, y=2.0, frame="map"):
    """A goal, looking along x."""
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation = Quaternion(0, 0, 0, 1)
    return message


def test_the_robot_stands_when_a_cycle_fails():
    """actionlib aborts the goal; nobody else would take the last velocity back."""
    ended = []
    node = MoveBase.__new__(MoveBase)
    node._values = {"shutdown_costmaps": False}
    node._navigator = SimpleNamespace(end=lambda: ended.append(True))

    def fails(_goal):
        raise ZeroDivisionError

    node._pursue = fails
    with pytest.raises(ZeroDivisionError):
        node._execute(MoveBaseGoal(pose()))
    assert ended == [True]


@pytest.fixture
def ends_threads(monkeypatch):
    """Those that go on until the node ends."""
    ended = threading.Event()
    monkeypatch.setattr(rospy, "is_shutdown", ended.is_set)
    yield
    ended.set()
    for thread in threading.enumerate():
        if thread.name == "planner":
            thread.join(60.0)


@pytest.mark.usefixtures("ends_threads")
def test_a_planner_that_fails_has_no_path_and_is_asked_again(lines):
    """The thread that plans must go on; else every later goal would wait for ever."""
    machine, asked, again = StateMachine(PATIENCE), [], threading.Event()

    def plan(_goal):
        asked.append(True)
        if len(asked) == 1:
            raise ValueError("a planner's own fault")
        again.set()
        return np.zeros((2, 3))

    planning = Planning(machine, plan, lambda: 0.01)
    planning.begin(machine.begin(time.monotonic()), pose())
    assert again.wait(60.0)
    end = time.monotonic() + 60.0
    while machine.state is State.PLANNING and time.monotonic() < end:
        time.sleep(0.01)
    assert planning.take_path() is not None and "a planner's own fault" in lines[0]


@pytest.mark.parametrize("place", [(math.nan, 0.0), (0.0, math.inf)])
def test_a_goal_that_is_nowhere_has_no_place(lines, place):
    """In whatever frame."""
    assert goals.in_frame(pose(*place), "map", None) is None
    assert "is nowhere" in lines[0]


def test_make_plan_frees_what_lies_within_the_clearing_radius(monkeypatch):
    """To each side, and no farther, as upstream."""
    monkeypatch.setattr(services.rospy, "Service", lambda *_: None)
    costmap = Costmap(np.full((41, 41), LETHAL, np.uint8), 0.1, (0.0, 0.0))
    planned_on = []
    fixed = SimpleNamespace(
        global_frame="map", footprint=None, is_ready=lambda: True,
        robot_pose=lambda: np.array([2.05, 2.05, 0.0]),
        snapshot=lambda: Costmap(costmap.cells.copy(), 0.1, (0.0, 0.0)))
    planner = SimpleNamespace(plan=lambda snapshot, *_: planned_on.append(snapshot))
    found = Services((fixed, fixed), None, lambda: planner,
                     lambda: {"make_plan_clear_costmap": True}, lambda: False, 0.5)
    found._make_plan(SimpleNamespace(start=PoseStamped(), goal=pose(), tolerance=0.0))
    rows, columns = np.nonzero(planned_on[0].cells != LETHAL)
    assert {(rows.min(), rows.max()), (columns.min(), columns.max())} == {(15, 25)}


def test_odometry_may_end_a_limit_while_it_is_applied():
    """Of move_slow_and_clear: it ends on odometry's thread."""
    base = Base.__new__(Base)
    base._closed, told = False, []
    base._tell_guard, base._publish = lambda _driven: None, told.append
    limits = [(0.1, 1.0)]
    type_of_base = type("Ending", (Base,), {"_limits": property(
        lambda _self: limits.pop() if limits else None)})
    base.__class__ = type_of_base
    base.drive(np.array([0.2, 0.0, 0.2]))
    assert told[0] == pytest.approx(np.array([0.1, 0.0, 0.1]))


@pytest.fixture
def watched():
    """Whether the robot may drive at 1 s, by odometry of that time and by a laser's ages."""
    return _watched


def _watched(odometry, ages, said=None, fault="", timeout=0.6):
    costmap = SimpleNamespace(global_frame="map", robot_pose=lambda: np.zeros(3),
                              is_ready=lambda: True, is_current=lambda: True,
                              ages=lambda: [MessageAge("laser", "placed laser", *ages)])
    base = SimpleNamespace(odom_topic="/odom", heard=rospy.Time.from_sec(odometry),
                           odometry_fault=fault)
    said = {} if said is None else said
    missing_data = SimpleNamespace(missing=lambda what, why, **_: said.update({what: why}),
                                   present=lambda what: said.pop(what, None))
    return Watch((costmap, costmap), base, None, missing_data).can_drive(1.0, timeout, False)


@pytest.mark.parametrize(("odometry", "scan", "drives"), [
    (1000.0, 0.1, False), (1.05, -999.0, False), (1.05, -0.05, True), (0.2, 0.1, False)])
def test_what_was_heard_before_the_clock_was_set_back_is_old(watched, odometry, scan, drives):
    """At 1 s after 1000 s; what another thread heard just now may be a little ahead."""
    assert watched(odometry, (scan, scan)) is drives


def test_the_robot_stands_by_a_sensor_that_says_nothing_of_use(watched):
    """It comes, but nobody knows from where; one line, and none beside that of tf."""
    said = {}
    assert watched(1.0, (0.1, 0.5), said) and not said
    assert not watched(1.0, (0.1, 0.7), said) and not said
    assert not watched(1.0, (0.1, 0.7, "its sweeps are long"), said)
    assert not watched(1.0, (0.1, 0.8), said)  # tf's line may come and go
    assert list(said) == ["placed laser"]
    assert said["placed laser"].startswith("its sweeps are long; the robot stands")
    assert watched(1.0, (0.1, 0.1), said) and not said
    assert not watched(1.0, (0.7, 0.8, "its sweeps are long"), said) and list(said) == ["laser"]


@pytest.fixture
def base():
    """One that is told 0.3 m/s and 1 rad/s at most, and drives."""
    found = Base.__new__(Base)
    found._velocity, found._limits, found.heard = np.zeros(3), None, None
    found._driven, found.odometry_fault, found.odom_topic = True, "", "/odom"
    found.expect(0.3, 1.0, 10.0)
    return found


def odometry(vx, omega, vy=0.0):
    message = Odometry()
    message.twist.twist.linear.x, message.twist.twist.linear.y = vx, vy
    message.twist.twist.angular.z = omega
    return message


@pytest.mark.parametrize("wrong", [(0.3, 1e8), (math.nan, 0.0), (0.1, -math.inf), (5.1, 0.0),
                                   (0.0, 10.1), (4.0, 0.0, 4.0), (1.7e308, 0.0, 1.7e308)])
def test_odometry_that_cannot_be_counts_as_missing(base, lines, watched, wrong):
    """One such message kept the loop from its next command for 8 s, and the robot drove on."""
    base._take(odometry(0.2, 0.5))
    before = base.heard
    for _ in range(2):
        base._take(odometry(*wrong))
    assert base.velocity.tolist() == [0.2, 0.0, 0.5] and base.heard is before
    assert len(lines) == 1 and "odometry on /odom: it says" in lines[0]
    said = {}
    assert not watched(0.2, (0.0, 0.0), said, base.odometry_fault)
    assert "it says" in said["odometry on /odom"] and "stands" in said["odometry on /odom"]
    base._take(odometry(0.1, 0.0))
    assert base.velocity.tolist() == [0.1, 0.0, 0.0] and not base.odometry_fault


def test_the_robot_stands_by_impossible_odometry_whatever_the_timeout(watched):
    """Planners would go on from the velocity of before it for ever."""
    assert watched(0.2, (9.0, 9.0), timeout=0.0)
    assert not watched(0.2, (9.0, 9.0), fault="it says 1e8 rad/s", timeout=0.0)


@pytest.mark.parametrize("pushed", [(4.9, 0.0), (-3.0, 9.0)])
def test_a_robot_may_be_pushed_faster_than_it_is_told(base, lines, pushed):
    """Or roll down a slope."""
    base._take(odometry(*pushed))
    assert base.velocity.tolist() == [pushed[0], 0.0, pushed[1]] and not lines


def test_without_a_factor_any_odometry_counts_that_is_a_number(base, lines):
    base.expect(0.3, 1.0, 0.0)
    base._take(odometry(50.0, 100.0))
    assert base.velocity.tolist() == [50.0, 0.0, 100.0] and not lines
    base._take(odometry(math.nan, 0.0))
    assert base.velocity[0] == 50.0 and "it says (nan" in lines[0]


@pytest.mark.parametrize("tolerance", [math.inf, 1e30, math.nan])
def test_make_plan_looks_no_farther_than_the_map_is_wide(monkeypatch, tolerance):
    """At places a step apart; with none of them free nothing is planned, and the answer is none."""
    monkeypatch.setattr(services.rospy, "Service", lambda *_: None)
    tried = []
    monkeypatch.setattr(services, "_is_open", lambda _costmap, place: tried.append(place))
    costmap = Costmap(np.full((40, 30), LETHAL, np.uint8), 0.1, (0.0, 0.0))
    fixed = SimpleNamespace(global_frame="map", footprint=None)
    found = Services((fixed, fixed), None, lambda: SimpleNamespace(plan=lambda *_: None),
                     dict, lambda: False, 0.5)
    goal = np.array([2.0, 2.0, 0.0])
    assert found._near_goal(costmap, goal, goal, tolerance) is None
    assert len(tried) == (0 if math.isnan(tolerance) else 27 ** 2 - 1)
