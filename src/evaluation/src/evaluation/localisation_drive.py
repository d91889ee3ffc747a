"""Drives amcl's trials: global localisation, kidnapped robot, tracking, CPU load."""

from __future__ import annotations

import argparse
import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
import rospy
from dynamic_reconfigure.msg import Config, IntParameter
from dynamic_reconfigure.srv import Reconfigure
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty

from evaluation.house import ROBOT, Watch, told_pose
from evaluation.trial import Case
from run_session import simulator
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.processes import processes
from run_session.session import StatusLine
from trial_worlds.house import Ground

FINDING, KIDNAPS, TRACKING, LOAD = "finding", "kidnaps", "tracking", "load"  # kinds of cases
RIGHT_OFF, RIGHT_OFF_DEG = 0.3, 15.0  # m and degrees: largest error of a pose that counts as right
HOLD = 20.0  # s, simulated, for which it must stay right
LIMITS = {FINDING: 60.0, KIDNAPS: 120.0}  # s, simulated, within which it must be right
START_LIMIT, STILL_LIMIT = 120.0, 30.0  # s, wall
LOOK_PERIOD = 0.05  # s, wall
FENCE = 0.8  # m ahead of the robot
TRUE, ENCODER = "<odometrySource>world<", "<odometrySource>encoder<"
call_service = partial(simulator.call, wait=STILL_LIMIT)


@dataclass(frozen=True)
class LocalisationCase(Case):
    """One robot to be localised, whose number is the seed, or one long drive."""

    seconds: int = 0  # of a long drive, simulated


@dataclass(frozen=True)
class Record:
    """What was seen in one case; m, rad, s."""

    case: LocalisationCase
    start: np.ndarray  # (3,), where the robot was put, in the world's frame
    times: np.ndarray  # (N,), simulated
    errors: np.ndarray  # (N, 2), of the estimated pose at these times: distance and turn
    touched: int = 0
    simulated: float = 0.0  # this and the next three are of a long drive
    wall: float = 0.0
    driven: float = 0.0
    cpu: float = 0.0  # time that amcl used


class LocalisationStack:
    """Made once per run; all of its methods may raise RunError."""

    def __init__(self, options: argparse.Namespace, ground: Ground, launched: Launched,
                 map_file: str, progress: StatusLine):
        self._launched, self.ground, self._progress = launched, ground, progress
        self.seed = options.seed
        launched.start_roscore()
        self.watch = Watch()
        launched.start("localisation", [
            "roslaunch", "evaluation", "localisation.launch", f"map_file:={map_file}",
            f"world_name:={options.house.world_path}", f"model:={options.house.model}",
            f"seed:={options.seed}", f"real_time_factor:={options.real_time_factor:g}"])
        self._told = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)
        self._wait("the simulator", simulator.models)
        self._start, self._by_wheels = options.house.start, None
        self.use_odometry(by_wheels=True)
        self.watch.start()
        self._wait("the robot in the simulator", lambda: self.watch.records.truth)
        self._wait("the map and amcl", lambda: self.watch.map is not None
                   and self._told.get_num_connections() and self.watch.records.believed)

    @property
    def now(self) -> float:
        """Simulated time, s."""
        return self.watch.records.now

    def may_go_on(self) -> bool:
        """Whether the robot, going straight on, would stay on the map, which ends at the house."""
        truth = self.watch.records.truth
        if not truth:
            return True
        _, x, y, yaw = truth[-1]
        point = np.array([x + FENCE * np.cos(yaw), y + FENCE * np.sin(yaw)])
        walls = self.ground.walls
        return bool(walls.contains(walls.cells_of(point)))

    def use_odometry(self, by_wheels: bool) -> None:
        """Respawn the robot, if necessary, with wheel odometry, or ground truth as TurtleBot3 has.

        Ground truth would tell amcl where the robot was moved.
        """
        if self._by_wheels == by_wheels:
            return
        urdf = self._wait("the robot's description",
                          lambda: rospy.get_param("/robot_description", ""))
        if TRUE not in urdf:
            raise RunError(f"/robot_description has no {TRUE}/odometrySource>: a kidnapped robot's "
                           "odometry must not know of it")
        if self._by_wheels is not None:
            simulator.delete(ROBOT)
        simulator.spawn_urdf(ROBOT, urdf.replace(TRUE, ENCODER) if by_wheels else urdf, "/",
                             *self._start[:2])
        self._by_wheels = by_wheels
        self.watch.feelers = self.ground.feelers(urdf)

    def put(self, place: np.ndarray) -> None:
        """Move the robot to a pose (3,) in the world, unnoticed by its wheel odometry."""
        simulator.put(ROBOT, tuple(place.tolist()), STILL_LIMIT)
        self.watch.begin()
        self._wait("the robot in its place", lambda: self.watch.records.truth and np.linalg.norm(
            self.watch.records.true_pose[:2] - place[:2]) < 0.2)

    def tell(self, place: np.ndarray) -> None:
        """Publish an initial pose (3,), in the world's frame, as rviz's 2D Pose Estimate does."""
        self._told.publish(told_pose(place, self.now))

    def forget(self) -> None:
        """Call /global_localization: the robot may be anywhere."""
        call_service("/global_localization", Empty)

    def look(self, part: str, what: str) -> None:
        """Waits a little, checks that everything still runs, shows progress."""
        before = self.now
        while self.now <= before:
            time.sleep(LOOK_PERIOD)
            self._launched.check_time(self.now, STILL_LIMIT)
        self.watch.records.show(self._progress, part, what)

    def set_pace(self, factor: float) -> None:
        """Set the real-time factor."""
        now = call_service("/gazebo/get_physics_properties", GetPhysicsProperties)
        call_service("/gazebo/set_physics_properties", SetPhysicsProperties,
                     now.time_step, factor / now.time_step, now.gravity, now.ode_config)

    def set_particles(self, count: int) -> None:
        """Have amcl use constantly this many particles."""
        names = "min_particles", "max_particles"
        answer = call_service("/amcl/set_parameters", Reconfigure,
                            Config(ints=[IntParameter(name, count) for name in names]))
        taken = {each.name: each.value for each in answer.config.ints}
        if any(taken.get(name) != count for name in names):
            raise RunError(f"amcl does not take {count} for {' and '.join(names)}")

    def meters(self) -> np.ndarray:
        """Simulated time, s, wall time, s, m driven, and CPU time of amcl, s (4,)."""
        cpu = sum(process.cpu for process in processes() if process.name == "amcl")
        return np.array([self.now, time.monotonic(), self.watch.records.length, cpu])

    def _wait(self, what: str, condition: Callable[[], object]) -> object:
        return self._launched.wait_for(what, condition, START_LIMIT, self._progress.status)


SETTLE = 15.0  # s, simulated, after an initial pose, that do not count
CARRIED = 2.0  # m, least straight distance that the robot is moved
TOLD_OFF = (0.3, 0.3, 0.26)  # m in x and y, and rad: largest error of an initial pose
PERIOD = 1.0  # s, simulated, between two checks whether it is localised
MOST_DRAWS = 1000
PARTICLES = 2000
SPEED, TURN_RATE = 0.22, 0.8  # m/s, rad/s
WEAVE = 0.15  # rad/s, of the random turns on the way
AHEAD, BESIDE = np.radians((25.0, 75.0))  # to either side
NEAR_AHEAD, NEAR_BESIDE = 0.55, 0.28  # m from the laser, below which it turns
CLEAR_AHEAD = 0.8  # m, above which it goes straight on again


def find(stack: LocalisationStack, case: LocalisationCase) -> Record:
    """Global localisation: a robot at an unknown place in the house."""
    random = np.random.default_rng([stack.seed, case.seed, 0])
    place = _draw_place(stack.ground, random)
    stack.put(place)
    stack.forget()
    return _search(stack, case, place, random)


def kidnap(stack: LocalisationStack, case: LocalisationCase) -> Record:
    """Kidnapped robot: a localised robot is moved elsewhere while it drives."""
    random = np.random.default_rng([stack.seed, case.seed, 1])
    _begin_known(stack, random)
    with wandering(stack.seed, stack.may_go_on):
        _watch_for(stack, SETTLE, f"before {KIDNAPS} {case.seed}",
                   "driving until it is carried away")
    place = _draw_place(stack.ground, random, stack.watch.records.true_pose)
    stack.put(place)
    return _search(stack, case, place, random)


def follow(stack: LocalisationStack, case: LocalisationCase) -> Record:
    """A long drive from a slightly wrong initial pose; the first SETTLE seconds do not count.

    CPU load is measured with a constant number of particles, at real-time pace.
    """
    loaded = case.set == LOAD
    if loaded:
        stack.set_pace(1.0)
    place = _begin_known(stack, np.random.default_rng([stack.seed, 0, 3 if loaded else 2]))
    if loaded:
        stack.set_particles(PARTICLES)
    with wandering(stack.seed, stack.may_go_on):
        _watch_for(stack, SETTLE, case.set, "finding itself")
        before = stack.meters()
        _watch_for(stack, case.seconds, case.set, "driving")
        used = stack.meters() - before
    return Record(case, place, *stack.watch.records.errors(before[0]), 0, *used.tolist())


def _begin_known(stack: LocalisationStack, random: np.random.Generator) -> np.ndarray:
    place = _draw_place(stack.ground, random)
    stack.put(place)
    stack.tell(place + random.uniform(-1, 1, 3) * TOLD_OFF)
    return place


def _search(stack: LocalisationStack, case: LocalisationCase, place: np.ndarray,
            random: np.random.Generator) -> Record:
    """Drives until the pose has been right for long enough, or no longer can be in time."""
    began = looked = stack.now
    what = "searching"
    with wandering(int(random.integers(1 << 31)), stack.may_go_on):
        while stack.now - began < LIMITS[case.set] + HOLD:
            stack.look(f"{case.set} {case.seed}", what)
            if stack.now - looked < PERIOD:
                continue
            looked = stack.now
            times, errors = stack.watch.records.errors(began)
            since = right_since(times, errors)
            what = "searching" if since is None else "right"
            if since is not None and times[-1] - since >= HOLD:
                break
    records = stack.watch.records
    times, errors = records.errors(began)
    return Record(case, place, times - began, errors, len(records.contacts))


def right_since(times: np.ndarray, errors: np.ndarray) -> float | None:
    """The time from which on all errors (N, 2), m and rad, at times (N,), s, are small; or None."""
    if not len(times):
        return None
    wrong = np.flatnonzero((errors > (RIGHT_OFF, np.radians(RIGHT_OFF_DEG))).any(axis=1))
    first = wrong[-1] + 1 if len(wrong) else 0
    return float(times[first]) if first < len(times) else None


def _watch_for(stack: LocalisationStack, seconds: float, part: str, what: str) -> None:
    until = stack.now + seconds
    while stack.now < until:
        stack.look(part, what)


RUNS = {FINDING: find, KIDNAPS: kidnap, TRACKING: follow, LOAD: follow}


def _draw_place(ground: Ground, random: np.random.Generator,
                away_from: np.ndarray | None = None) -> np.ndarray:
    """A random pose (3,) in the world where the robot has room, CARRIED away from `away_from`."""
    for _ in range(MOST_DRAWS):
        place = ground.draw_goals(1, int(random.integers(1 << 31)))[0]
        if away_from is None or np.linalg.norm(place[:2] - away_from[:2]) >= CARRIED:
            return place
    raise RunError(f"no place {CARRIED:g} m away: change the house file")


class Steering:
    """Chooses a velocity by a scan. It needs no map and no pose, as a lost robot has none."""

    def __init__(self, seed: int):
        self._random = np.random.default_rng([seed, 2])
        self._turning = 0.0  # rad/s; 0: straight on

    def choose(self, ranges: np.ndarray, bearings: np.ndarray, may_go_on: bool = True
               ) -> tuple[float, float]:
        """m/s and rad/s for ranges (N,), m, at bearings (N,), rad, -pi to pi, left is positive."""
        ahead = ranges[np.abs(bearings) < AHEAD].min()
        beside = ranges[np.abs(bearings) < BESIDE].min()
        wanted = CLEAR_AHEAD if self._turning else NEAR_AHEAD
        if not may_go_on or beside < NEAR_BESIDE or ahead < wanted:
            if not self._turning:
                left = ranges[(bearings > 0) & (bearings < 2)].mean()
                right = ranges[(bearings < 0) & (bearings > -2)].mean()
                self._turning = TURN_RATE if left > right else -TURN_RATE
            return 0.0, self._turning
        self._turning = 0.0
        return SPEED, float(self._random.normal(0.0, WEAVE))


@contextlib.contextmanager
def wandering(seed: int, may_go_on: Callable[[], bool]) -> Iterator[None]:
    """A context in which each scan is answered by a command; `may_go_on`: may it go straight on?"""
    steering, commands = Steering(seed), rospy.Publisher("/cmd_vel", Twist, queue_size=1)
    ended = threading.Event()

    def take(message: LaserScan) -> None:
        ranges = np.array(message.ranges)
        ranges[~(ranges >= message.range_min)] = message.range_max
        bearings = message.angle_min + message.angle_increment * np.arange(len(ranges))
        command = Twist()
        command.linear.x, command.angular.z = steering.choose(
            np.minimum(ranges, message.range_max), (bearings + np.pi) % (2 * np.pi) - np.pi,
            may_go_on())
        commands.publish(command)
        if ended.is_set():  # meanwhile: the robot has already been stopped
            commands.publish(Twist())

    scans = rospy.Subscriber("/scan", LaserScan, take, queue_size=1)
    try:
        yield
    finally:
        scans.unregister()
        ended.set()
        commands.publish(Twist())
