"""Limits the velocity at which overlapping bodies separate (ODE: contact_max_correcting_vel).

A deeper contact pushes harder: a robot that is spawned 6 cm deep in the floor, as in many launch
files, would leave it at 5 m/s. ODE limits that speed (ODE manual,
dWorldSetContactMaxCorrectingVel), Bullet does not; so while anything is so deep, all contacts of
the world only correct a small part of their depth per step.
"""

from collections.abc import Callable, Sequence

from bullet_sim.physics.auto_disable import SimulatedBody
from bullet_sim.physics.engine import pybullet

CORRECTED = 0.08  # part of the depth per step; PyBullet's own, for rigid contacts
ALL = 1.0  # less deep contacts separate at the engine's own velocity
FASTEST = 0.2  # m/s, of separation
LONGEST = 5.0  # s, simulated, after which there is no limit any more
MANY_BODIES = 64  # from which on a check, which reads all contacts, costs as much as the step
SELDOM = 10  # steps from one check to the next then; what separates moves 2 mm meanwhile
DISTANCE = 8  # column of getContactPoints: m, below 0 where shapes overlap


class CorrectingVelocityLimit:
    """Checks the depths before each step, from when a body was placed until none is deep.

    `run` runs a pybullet function in the engine; `bodies` is the list of all bodies.
    """

    def __init__(self, run: Callable, bodies: Sequence[SimulatedBody]):
        self._run = run
        self._bodies = bodies
        self._part: float | None = ALL  # that all bodies correct; None: one was added since
        self._left = 0.0  # s, for which checks continue
        self._unchecked = 0  # steps until the next check

    def watch(self) -> None:
        """Start checking: a body was placed."""
        self._left, self._part, self._unchecked = LONGEST, None, 0

    def before_step(self, timestep: float) -> None:
        """Choose the part of the depth that the next step, of `timestep` (s), corrects."""
        if not self._left:
            return
        self._left = max(0.0, self._left - timestep)
        self._unchecked -= 1
        if self._left and self._unchecked > 0:
            return
        self._unchecked = SELDOM if len(self._bodies) >= MANY_BODIES else 0
        deepest = self._deepest() if self._left else 0.0
        part = min(ALL, FASTEST * timestep / deepest) if deepest > 0.0 else ALL
        if part == ALL:
            self._left = 0.0
        if part != self._part:
            self._limit(part, timestep)

    def _limit(self, part: float, timestep: float) -> None:
        self._part = part
        self._run(pybullet.setPhysicsEngineParameter, contactERP=min(CORRECTED, part))
        for body in self._bodies:
            body.limit_correcting_velocity(None if part == ALL else part, timestep)

    def _deepest(self) -> float:
        """Maximum depth of all contacts, m; 0 or less if nothing overlaps."""
        self._run(pybullet.performCollisionDetection)
        return max((-row[DISTANCE] for row in self._run(pybullet.getContactPoints)),
                   default=0.0)
