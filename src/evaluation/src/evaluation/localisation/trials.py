"""The trials: global localisation, kidnapped robot, tracking, and amcl's CPU load."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from evaluation.localisation import outcomes
from evaluation.localisation.outcomes import FINDING, HOLD, KIDNAPS, LIMITS, Load, Tracking, Trial
from evaluation.localisation.rig import Rig
from run_session.failure import RunError
from trial_worlds.ground import Ground

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


def find(rig: Rig, ground: Ground, seed: int, number: int) -> Trial:
    """Global localisation: a robot at an unknown place in the house."""
    random = np.random.default_rng([seed, number, 0])
    place = _draw_place(ground, random)
    rig.put(place)
    rig.forget()
    return _search(rig, FINDING, number, place, random)


def kidnap(rig: Rig, ground: Ground, seed: int, number: int) -> Trial:
    """Kidnapped robot: a localised robot is moved elsewhere while it drives."""
    random = np.random.default_rng([seed, number, 1])
    _begin_known(rig, ground, random)
    with wandering(seed, rig.may_go_on):
        _watch_for(rig, SETTLE, f"before {KIDNAPS} {number}", "driving until it is carried away")
    place = _draw_place(ground, random, rig.watch.records.true_pose)
    rig.put(place)
    return _search(rig, KIDNAPS, number, place, random)


def track(rig: Rig, ground: Ground, seed: int, seconds: float) -> Tracking:
    """A long drive from a slightly wrong initial pose; the first SETTLE seconds do not count."""
    random = np.random.default_rng([seed, 0, 2])
    _begin_known(rig, ground, random)
    with wandering(seed, rig.may_go_on):
        _watch_for(rig, SETTLE, "tracking", "finding itself")
        since, before = rig.now, rig.watch.records.length
        _watch_for(rig, seconds, "tracking", "driving")
    records = rig.watch.records
    _, errors = records.errors(since)
    if not len(errors):
        raise RunError("amcl said no pose while it should have tracked the robot")
    return outcomes.tracking(seconds, records.length - before, errors)


def measure_load(rig: Rig, ground: Ground, seed: int, seconds: float) -> Load:
    """CPU time of amcl with a constant number of particles, at real-time pace."""
    rig.set_pace(1.0)
    _begin_known(rig, ground, np.random.default_rng([seed, 0, 3]))
    rig.set_particles(PARTICLES)
    with wandering(seed, rig.may_go_on):
        _watch_for(rig, SETTLE, "load", "driving off")
        began, used, wall = rig.now, rig.cpu(), time.monotonic()
        _watch_for(rig, seconds, "load", "driving")
        simulated, used = rig.now - began, rig.cpu() - used
        wall = time.monotonic() - wall
    return Load(PARTICLES, simulated, wall, 100.0 * used / simulated)


def _begin_known(rig: Rig, ground: Ground, random: np.random.Generator) -> None:
    place = _draw_place(ground, random)
    rig.put(place)
    rig.tell(place + random.uniform(-1, 1, 3) * TOLD_OFF)


def _search(rig: Rig, kind: str, number: int, place: np.ndarray,
            random: np.random.Generator) -> Trial:
    """Drives until the pose has been right for long enough, or no longer can be in time."""
    began = looked = rig.now
    since, what, part = None, "searching", f"{kind} {number}"
    with wandering(int(random.integers(1 << 31)), rig.may_go_on):
        while rig.now - began < LIMITS[kind] + HOLD:
            rig.look(part, what)
            if rig.now - looked < PERIOD:
                continue
            looked = rig.now
            times, errors = rig.watch.records.errors(began)
            since = outcomes.right_since(times, errors)
            what = "searching" if since is None else "right"
            if since is not None and times[-1] - since >= HOLD:
                break
    times, errors = rig.watch.records.errors(began)
    return outcomes.searched(kind, number, tuple(np.round(place, 3).tolist()), began, times, errors,
                    len(rig.watch.records.contacts))


def _watch_for(rig: Rig, seconds: float, part: str, what: str) -> None:
    until = rig.now + seconds
    while rig.now < until:
        rig.look(part, what)


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
