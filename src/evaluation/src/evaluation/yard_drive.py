"""One drive of move_base through a yard or past a person: simulator, goal, gaps, contacts."""

from __future__ import annotations

import math
import queue
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal, RecoveryStatus
from std_srvs.srv import Empty

from evaluation.trial import Case
from run_session import simulator
from run_session.launch import Launched
from run_session.simulator import WAFFLE, Place, place_of, pose_message
from trial_worlds import crossing
from trial_worlds.crossing import CONTACT, PERSON_RADIUS, Crossing, clearance
from trial_worlds.yard import RADIUS, draw_yard

START_LIMIT, ANSWER_LIMIT, SILENCE = 120.0, 30.0, 30.0  # s, wall
FRESH = 0.7  # s, simulated, to renew costmaps: laser at 5 Hz, its transform, costmap at 10 Hz
PERSON = "person"
UNDER_WAY = (GoalStatus.PENDING, GoalStatus.ACTIVE, GoalStatus.PREEMPTING, GoalStatus.RECALLING)
SLOW = "missed its desired rate"  # in move_base's warning
WAIT_PERIOD = 0.02  # s, wall


STANDING = 0.02   # m/s
PATH_STEP = 0.02  # m between two recorded points
OBSTACLE, BY_ROBOT, BY_PERSON = (
    "touched an obstacle", "touched the person", "the person walked into the standing robot")


@dataclass(frozen=True)
class Sample:
    """Positions of robot and person, by the simulator."""

    time: float  # s, simulated
    robot: Place
    speed: float  # m/s, of the robot
    person: Place | None


class Passage:
    """Sees one drive from its first sample on; after a contact nothing more counts."""

    def __init__(self, cylinders: np.ndarray):
        """`cylinders` (N, 2): their centres, m; none in an empty room."""
        self._cylinders = cylinders
        self._began: float | None = None
        self._last: Sample | None = None
        self.time = self.distance = 0.0  # s, m
        self.to_obstacles = self.to_person = math.inf  # least gaps so far, m
        self.contact: str | None = None
        self.path: list[tuple[float, ...]] = []  # s, x, y, yaw, every PATH_STEP

    def see(self, sample: Sample) -> None:
        """Take the next sample."""
        if self.contact:
            return
        self._began = sample.time if self._began is None else self._began
        self.time = sample.time - self._began
        if self._last is not None:
            self.distance += math.dist(self._last.robot[:2], sample.robot[:2])
        self._last = sample
        if not self.path or math.dist(self.path[-1][1:3], sample.robot[:2]) >= PATH_STEP:
            self.path.append((self.time, *sample.robot))
        self._look(sample)

    def off(self, place: Place) -> float:
        """The robot's last distance from a place, m; inf before the first sample."""
        return math.inf if self._last is None else math.dist(self._last.robot[:2], place[:2])

    def _look(self, sample: Sample) -> None:
        air = clearance(sample.robot, self._cylinders, RADIUS)
        self.to_obstacles = min(self.to_obstacles, air)
        if air < CONTACT:
            self.contact = OBSTACLE
        if sample.person is None:
            return
        air = clearance(sample.robot, np.array([sample.person[:2]]), PERSON_RADIUS)
        self.to_person = min(self.to_person, air)
        if air < CONTACT:
            self.contact = BY_PERSON if sample.speed < STANDING else BY_ROBOT


class NavigationStack:
    """Made once per run; all of its methods may raise RunError."""

    def __init__(self, launched: Launched, real_time_factor: float, parameters: Path):
        self._launched = launched
        launched.start_roscore()
        launched.start("yard", [
            "roslaunch", "evaluation", "yard.launch", f"real_time_factor:={real_time_factor:g}",
            f"parameters:={parameters}"])
        self.wait(lambda: WAFFLE in simulator.models(), f"model {WAFFLE}", START_LIMIT)
        rospy.init_node("navigation_trials", disable_signals=True, disable_rosout=True)
        self._samples: queue.SimpleQueue[Sample] = queue.SimpleQueue()
        self._newest = 0.0  # s, simulated, of the last sample
        self.recoveries: list[str] = []
        self._slow_before = 0
        self._there: set[str] = set()
        self._walk = rospy.Publisher(crossing.PERSON_TOPIC, Twist, queue_size=1)
        rospy.Subscriber("gazebo/model_states", ModelStates, self._take, queue_size=1)
        rospy.Subscriber("move_base/recovery_status", RecoveryStatus, self._take_recovery)
        self._client = actionlib.ActionClient("move_base", MoveBaseAction)
        self._goal: actionlib.ClientGoalHandle | None = None
        self.wait(lambda: self._client.wait_for_server(rospy.Duration(0.1)),
                  "the action server of move_base", START_LIMIT)

    def prepare(self, models: dict[str, tuple[str, Place]], start: Place) -> None:
        """Replace the models by these (SDF and pose by name) and put the robot at `start`.

        Its costmaps then hold only what it sees from there.
        """
        for name in sorted(self._there):
            simulator.delete(name)
            self._there.discard(name)
        simulator.put(WAFFLE, start, ANSWER_LIMIT)
        for name, (text, place) in models.items():
            simulator.spawn_sdf(name, text, place)
            self._there.add(name)
        self.pause(FRESH)
        simulator.call("/move_base/clear_costmaps", Empty, wait=ANSWER_LIMIT)
        self.pause(FRESH)
        self.samples()
        self.recoveries.clear()
        self._slow_before = self._launched.count_said(SLOW)

    def send(self, goal: Place) -> None:
        """Send the robot a goal."""
        message = MoveBaseGoal()
        message.target_pose.header.frame_id = "odom"  # the drive plugin's odometry is the true pose
        message.target_pose.pose = pose_message(goal)
        self._goal = self._client.send_goal(message)

    def result(self) -> str | None:
        """How the goal ended: "reached", or the action's status and text; None until it has."""
        status = self._goal.get_goal_status()
        if status in UNDER_WAY:
            return None
        if status == GoalStatus.SUCCEEDED:
            return "reached"
        return f"{GoalStatus.to_string(status).lower()}: {self._goal.get_goal_status_text()}"

    def end_goal(self) -> None:
        """Cancel the goal if it is active; returns when it has ended."""
        if self.result() is None:
            self._goal.cancel()
            self.wait(lambda: self.result() is not None, "the end of the cancelled goal")

    def walk(self, speed: float) -> None:
        """Have the person walk at this speed, m/s; 0: stand."""
        message = Twist()
        message.linear.x = speed
        self._walk.publish(message)

    def person_listens(self) -> bool:
        """Whether the person's velocity commands have a subscriber."""
        return self._walk.get_num_connections() > 0

    def samples(self, wait: float = 0.0) -> list[Sample]:
        """All samples since the last call, after waiting this long, s, wall.

        RunError if none comes within SILENCE.
        """
        time.sleep(wait)
        found = []
        while not self._samples.empty():
            found.append(self._samples.get_nowait())
            self._newest = found[-1].time
        self._launched.check_time(self._newest, SILENCE)
        return found

    def pause(self, seconds: float) -> None:
        """Wait for this long, s, simulated."""
        until = rospy.get_time() + seconds
        self.wait(lambda: rospy.get_time() >= until, "simulated time")

    @property
    def slow_cycles(self) -> int:
        """Number since `prepare`; move_base warns that it was too slow at most once in 5 s."""
        return self._launched.count_said(SLOW) - self._slow_before

    def wait(self, condition: Callable[[], bool], what: str, limit: float = ANSWER_LIMIT) -> None:
        """Returns once the condition is true; RunError after `limit`, s, wall."""
        self._launched.wait_for(what, condition, limit, pause=WAIT_PERIOD)

    def _take(self, message: ModelStates) -> None:
        places = dict(zip(message.name, message.pose, strict=True))
        if WAFFLE not in places:
            return
        motion = message.twist[message.name.index(WAFFLE)].linear
        self._samples.put(Sample(
            rospy.get_time(), place_of(places[WAFFLE]), math.hypot(motion.x, motion.y),
            place_of(places[PERSON]) if PERSON in places else None))

    def _take_recovery(self, message: RecoveryStatus) -> None:
        self.recoveries.append(message.recovery_behavior_name)


LOOK_PERIOD = 0.05  # s, wall
LIMIT = 100.0       # s, simulated, as in the benchmark
ORIGIN = (0.0, 0.0, 0.0)
YARDS, CROSSINGS = "yards", "crossings"  # the two sets of drives


@dataclass(frozen=True)
class Task:
    """The task of a drive; m, rad."""

    case: Case
    models: dict[str, tuple[str, Place]]  # SDF and pose, by name
    start: Place
    goal: Place
    shortest: float  # length of the shortest path
    cylinders: np.ndarray  # (N, 2), centres
    drawn: dict
    walk: Crossing | None = None


@dataclass(frozen=True)
class Record:
    """What happened in one drive."""

    task: Task
    passage: Passage
    ended: str  # "reached", or why not
    recoveries: list[str]
    slow_cycles: int
    real_time_factor: float


def task_of(case: Case) -> Task:
    """The task: through a yard, or through a room that a person walks across."""
    if case.set == YARDS:
        yard = draw_yard(case.seed)
        models = {"yard": (crossing.yard_model(yard), ORIGIN)}
        drawn = {"fill": yard.fill, "smoothing": yard.smoothing,
                 "path_length": yard.path_length, **asdict(yard.difficulty)}
        return Task(case, models, yard.start(case.repeat), yard.goal, yard.path_length,
                    yard.cylinders, drawn)
    walk, start, goal = crossing.draw_crossing(case.seed), crossing.START, crossing.GOAL
    models = {"room": (crossing.model("room"), ORIGIN),
              PERSON: (crossing.model("person"), walk.begin)}
    return Task(case, models, start, goal, math.dist(start[:2], goal[:2]), np.empty((0, 2)),
                asdict(walk), walk)


def drive_task(stack: NavigationStack, task: Task) -> Record:
    """Set up the task's world, and drive from start to goal, or as far as the robot gets."""
    stack.prepare(task.models, task.start)
    if task.walk is not None:
        stack.wait(stack.person_listens, "the person")
    passage, began = Passage(task.cylinders), time.monotonic()
    ended = _watch(stack, passage, task)
    pace = passage.time / (time.monotonic() - began)
    stack.walk(0.0)
    stack.end_goal()
    return Record(task, passage, ended, list(stack.recoveries), stack.slow_cycles, pace)


def _watch(stack: NavigationStack, passage: Passage, task: Task) -> str:
    """Watch until the goal has ended; returns how."""
    stack.send(task.goal)
    walk, walking, ended = task.walk, None, None  # None: the person waits
    while ended is None:
        ended = stack.result()  # before the samples, so that all of those before the end count
        for sample in stack.samples(LOOK_PERIOD):
            passage.see(sample)
            if walk and walking is None and sample.robot[0] >= walk.trigger:
                walking = True
                stack.walk(walk.speed)
            elif walking and math.dist(sample.person[:2], walk.begin[:2]) > 2 * crossing.APPROACH:
                walking = False
                stack.walk(0.0)
        if passage.contact or passage.time > LIMIT:
            ended = passage.contact or f"not there within {LIMIT:.0f} s"
    return ended
