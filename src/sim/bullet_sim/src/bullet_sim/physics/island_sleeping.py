"""Disables groups of touching bodies that move too slowly to get anywhere (Bullet's islands).

Overlapping shapes push one another without end, too fast for `auto_disable` and too slowly to get
anywhere. As in Gazebo's ODEPhysics::Load (physics/ode/ODEPhysics.cc): models without joints that
touch are disabled once all of them stayed below 0.1 m/s and 0.1 rad/s for a second; any change of
one of them, or a push, ends that. Unlike there, the means over that second count, a body that
touches no other such body stays enabled (a ball that rolls slowly keeps rolling), and a quarter of
a second is enough for 64 bodies or more, of which Bullet solves some ten steps in a second.
"""

import math
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from operator import mul

from bullet_sim.physics.auto_disable import SAMPLE_PERIOD, SimulatedBody
from bullet_sim.physics.engine import pybullet

SPEED = 0.1  # m/s, of the mean over SAMPLES: ODEPhysics::Load's threshold
RATE = 0.1  # rad/s
TREMBLING = 3.0  # times as fast it may be between two samples
SAMPLES = round(1.0 / SAMPLE_PERIOD)  # a second, as there
MANY_BODIES = 64  # in one island, for which FEW_SAMPLES are enough
FEW_SAMPLES = round(0.25 / SAMPLE_PERIOD)
# (m/s)^2 + (rad/s)^2 above which the engine wakes a body that is pushed
SLEEP_THRESHOLD = 2 * 0.05 ** 2
# The same while it falls asleep: the engine solves one more step, which pushes.
FALLING_ASLEEP_THRESHOLD = 1e6
MOTORS = (pybullet.setJointMotorControl2, pybullet.setJointMotorControlArray,
          pybullet.setJointMotorControlMultiDof)
PUSHES = (pybullet.applyExternalForce, pybullet.applyExternalTorque, pybullet.resetBaseVelocity)
FIRST, SECOND = 1, 2  # columns of getContactPoints: the bodies that touch


class IslandSleeping:
    """Call `after_step` after every step, `changed` for every change.

    `run` runs a pybullet function without waking anything; `bodies` is the list of all bodies.
    """

    def __init__(self, run: Callable, bodies: Sequence[SimulatedBody]):
        self._run = run
        self._bodies = bodies
        self._poses: dict[int, deque] = {}  # by number, of the samples since it was last fast
        self._disabled: set[int] = set()
        self._early: set[int] = set()  # those of them that were not slow for a second yet
        self._falling_asleep: set[int] = set()  # those of them from the last sample
        self._waking: set[int] = set()  # enabled since the last step; not yet in the next one
        self._late: list[tuple[Callable, tuple]] = []  # pushes of those, to be repeated

    def after_step(self, sampling: bool) -> None:
        """`sampling`: at a sample of AutoDisable, disable bodies that have been slow."""
        if self._waking:
            for push, args in self._late:
                self._run(push, *args)
            self._late.clear()
            self._waking.clear()
        if not sampling:
            return
        poses = {body.number: self._run(pybullet.getBasePositionAndOrientation, body.number)
                 for body in self._bodies if body.auto_disables}
        self._poses = {number: self._quiet(number, pose) for number, pose in poses.items()}
        ready = self._slow(SAMPLES)
        nearly = self._slow(FEW_SAMPLES) if len(poses) >= MANY_BODIES else set()
        self._early &= nearly - ready
        self._disabled &= ready | self._early
        for number in self._falling_asleep & self._disabled:
            self._run(pybullet.changeDynamics, number, -1, sleepThreshold=SLEEP_THRESHOLD)
        self._falling_asleep.clear()
        if ready - self._disabled or len(nearly - self._disabled) >= MANY_BODIES:
            self._disable(ready, nearly)

    def _slow(self, samples: int) -> set[int]:
        """Numbers of the bodies whose mean speed over the last `samples` was low."""
        return {number for number, seen in self._poses.items()
                if len(seen) > samples
                and _slower(seen[-1 - samples], seen[-1], samples * SAMPLE_PERIOD)}

    def _quiet(self, number: int, pose: tuple) -> deque:
        """Its poses since it was last faster than a vibration."""
        seen = self._poses.get(number)
        if seen is None or not _slower(seen[-1], pose, TREMBLING * SAMPLE_PERIOD):
            return deque([pose], maxlen=SAMPLES + 1)
        seen.append(pose)
        return seen

    def changed(self, function: Callable, args: tuple) -> bool:
        """Enable the bodies affected by a pybullet call; returns whether there were any."""
        if function in MOTORS:
            return False
        push = function in PUSHES
        concerned = self._disabled & {args[0]} if push else set(self._disabled)
        for number in concerned:
            self._activate(number, pybullet.ACTIVATION_STATE_WAKE_UP)
            self._activate(number, pybullet.ACTIVATION_STATE_DISABLE_SLEEPING)
            self._poses.pop(number, None)
        self._disabled -= concerned
        self._waking |= concerned
        if push:
            self._poses.pop(args[0], None)  # a body that is pushed continuously must stay enabled
            if args[0] in self._waking:
                self._late.append((function, args))
        elif function is pybullet.removeBody:
            self._late = [late for late in self._late if late[1][0] != args[0]]
        return bool(concerned)

    def _disable(self, ready: set[int], nearly: set[int]) -> None:
        """`ready`: slow for long enough; `nearly`: for long enough in an island of many bodies."""
        still = {body.number for body in self._bodies if body.tree.fixed_base}
        for island in _islands(self._touching(), still):
            slow = ready | nearly if len(island) >= MANY_BODIES else ready
            if len(island) > 1 and island <= slow and not island <= self._disabled:
                for number in island:
                    self._run(pybullet.resetBaseVelocity, number, (0, 0, 0), (0, 0, 0))
                    self._activate(number, pybullet.ACTIVATION_STATE_ENABLE_SLEEPING,
                                   sleepThreshold=FALLING_ASLEEP_THRESHOLD)
                    self._activate(number, pybullet.ACTIVATION_STATE_SLEEP)
                self._disabled |= island
                self._early |= island - ready
                self._falling_asleep |= island

    def _touching(self) -> set[tuple[int, int]]:
        return {(row[FIRST], row[SECOND]) for row in self._run(pybullet.getContactPoints)}

    def _activate(self, number: int, state: int, **values: float) -> None:
        self._run(pybullet.changeDynamics, number, -1, activationState=state, **values)


def _slower(before: tuple, after: tuple, seconds: float) -> bool:
    """Whether both speeds, linear and angular, were below their thresholds between the poses."""
    moved = math.dist(before[0], after[0])
    turned = 2 * math.acos(min(1.0, abs(sum(map(mul, before[1], after[1])))))
    return moved < SPEED * seconds and turned < RATE * seconds


def _islands(pairs: Iterable[tuple[int, int]], still: set[int]) -> list[set[int]]:
    """Sets of bodies that touch, also through others; static bodies belong to none.

    A body that only touches static ones is a set by itself; one without contact is in none.
    """
    islands: dict[int, set[int]] = {}
    for pair in pairs:
        joined = set().union(*(islands.get(number, {number}) for number in pair
                               if number not in still))
        for number in joined:
            islands[number] = joined
    return list({id(island): island for island in islands.values()}.values())
