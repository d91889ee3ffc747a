"""One drive of move_base through a yard or past a person: simulator, goal, judgement."""

from __future__ import annotations

import math
import queue
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import DeleteModel, SpawnModel
from geometry_msgs.msg import Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal, RecoveryStatus
from std_srvs.srv import Empty

from evaluation import yard_judge
from evaluation.trial import Case
from evaluation.yard_judge import WALKED_INTO_ROBOT, DriveResult, Judge, Sample
from run_session.launch import Launched
from run_session.simulator import WAFFLE, Place, call, models, place_of, pose_message, put
from trial_worlds import crossing
from trial_worlds.crossing import (
    APPROACH,
    PERSON_TOPIC,
    ROBOT_SPEED,
    Crossing,
    person_model,
    room_model,
    yard_model,
)
from trial_worlds.yard import draw_yard

START_LIMIT, ANSWER_LIMIT, SILENCE = 120.0, 30.0, 30.0  # s, wall
FRESH = 0.7  # s, simulated, to renew costmaps: laser at 5 Hz, its transform, costmap at 10 Hz
PERSON = "person"
UNDER_WAY = (GoalStatus.PENDING, GoalStatus.ACTIVE, GoalStatus.PREEMPTING, GoalStatus.RECALLING)
SLOW = "missed its desired rate"  # in move_base's warning
WAIT_PERIOD = 0.02  # s, wall
call_service = partial(call, wait=ANSWER_LIMIT)


class NavigationStack:
    """Made once per run; all of its methods may raise RunError."""

    def __init__(self, launched: Launched, real_time_factor: float, parameters: Path):
        self._launched = launched
        launched.start_roscore()
        launched.start("yard", [
            "roslaunch", "evaluation", "yard.launch", f"real_time_factor:={real_time_factor:g}",
            f"parameters:={parameters}"])
        self.wait(lambda: WAFFLE in models(), f"model {WAFFLE}", START_LIMIT)
        rospy.init_node("navigation_trials", disable_signals=True, disable_rosout=True)
        self._samples: queue.SimpleQueue[Sample] = queue.SimpleQueue()
        self.recoveries: list[str] = []
        self._slow_before = 0
        self._there: set[str] = set()
        self._walk = rospy.Publisher(PERSON_TOPIC, Twist, queue_size=1)
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
            call_service("/gazebo/delete_model", DeleteModel, name)
            self._there.discard(name)
        put(WAFFLE, start, ANSWER_LIMIT)
        for name, (text, place) in models.items():
            call_service("/gazebo/spawn_sdf_model", SpawnModel, name, text, "", pose_message(place),
                       "world")
            self._there.add(name)
        self.pause(FRESH)
        call_service("/move_base/clear_costmaps", Empty)
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
        """All samples since the last call, after waiting this long, s, wall."""
        time.sleep(wait)
        self._launched.check_time(rospy.get_time(), SILENCE)
        found = []
        while not self._samples.empty():
            found.append(self._samples.get_nowait())
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
NEAR = 0.2          # m from a goal that is reported reached, by the simulator's own pose
ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class YardCase(Case):
    """One drive."""

    set: str
    seed: int
    repeat: int


@dataclass(frozen=True)
class Task:
    """The task of a drive; m, rad."""

    case: YardCase
    models: dict[str, tuple[str, Place]]  # SDF and pose, by name
    start: Place
    goal: Place
    shortest: float  # length of the shortest path
    cylinders: np.ndarray  # (N, 2), centres
    drawn: dict
    walk: Crossing | None = None


def task_of(case: YardCase) -> Task:
    """The task: through a yard, or through a room that a person walks across."""
    if case.set == yard_judge.YARDS:
        yard = draw_yard(case.seed)
        drawn = {"fill": yard.fill, "smoothing": yard.smoothing,
                 "path_length": yard.path_length, **asdict(yard.difficulty)}
        return Task(case, {"yard": (yard_model(yard), ORIGIN)}, yard.start(case.repeat), yard.goal,
                    yard.path_length, yard.cylinders, drawn)
    walk, start, goal = crossing.draw_crossing(case.seed), crossing.START, crossing.GOAL
    models = {"room": (room_model(), ORIGIN), PERSON: (person_model(), walk.begin)}
    return Task(case, models, start, goal, math.dist(start[:2], goal[:2]), np.empty((0, 2)),
                asdict(walk), walk)


def prepare(stack: NavigationStack, task: Task) -> None:
    """Set up the task's world, with the robot at its start."""
    stack.prepare(task.models, task.start)
    if task.walk is not None:
        stack.wait(stack.person_listens, "the person")


def drive_task(stack: NavigationStack, task: Task, judge: Judge) -> DriveResult:
    """Drive from start to goal, or as far as the robot gets; the judge gets all samples."""
    ended, pace = _watch(stack, judge, task)
    straight, outcome = math.dist(task.start[:2], task.goal[:2]), _outcome(judge, ended, task.goal)
    if outcome == yard_judge.NOT_THERE:
        ended = f"from {judge.off(task.goal):.2f} m away"
    return DriveResult(
        set=task.case.set, seed=task.case.seed, repeat=task.case.repeat, outcome=outcome,
        why=None if ended == yard_judge.REACHED else ended, time=round(judge.time, 2),
        distance=round(judge.distance, 3), straight_time=round(straight / ROBOT_SPEED, 2),
        shortest_time=round(task.shortest / ROBOT_SPEED, 2),
        to_obstacles=_known(judge.to_obstacles), to_person=_known(judge.to_person),
        recoveries=list(stack.recoveries), slow_cycles=stack.slow_cycles,
        real_time_factor=round(pace, 2), drawn=task.drawn)


def _watch(stack: NavigationStack, judge: Judge, task: Task) -> tuple[str, float]:
    """Watch until the goal has ended; returns how, and the real-time factor."""
    stack.send(task.goal)
    began, ended = time.monotonic(), None
    walk, walking = task.walk, None  # None: the person waits
    while ended is None:
        ended = stack.result()  # before the samples, so that all of those before the end count
        for sample in stack.samples(LOOK_PERIOD):
            judge.see(sample)
            if walk and walking is None and sample.robot[0] >= walk.trigger:
                walking = True
                stack.walk(walk.speed)
            elif walking and math.dist(sample.person[:2], walk.begin[:2]) > 2 * APPROACH:
                walking = False
                stack.walk(0.0)
        if judge.contact or judge.time > LIMIT:
            ended = judge.contact or f"not there within {LIMIT:.0f} s"
    wall = time.monotonic() - began
    if walk:
        stack.walk(0.0)
    stack.end_goal()
    return ended, judge.time / wall


def _outcome(judge: Judge, ended: str, goal: Place) -> str:
    if judge.contact == WALKED_INTO_ROBOT:
        return yard_judge.WALKED_INTO
    if judge.contact:
        return yard_judge.TOUCHED
    if ended == yard_judge.REACHED:
        return yard_judge.REACHED if judge.off(goal) <= NEAR else yard_judge.NOT_THERE
    return yard_judge.LATE if judge.time > LIMIT else yard_judge.GIVEN_UP


def _known(air: float) -> float | None:
    return None if math.isinf(air) else round(air, 4)
