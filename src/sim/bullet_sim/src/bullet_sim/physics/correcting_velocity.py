"""Bounds the velocity at which overlapping bodies separate (ODE: contact_max_correcting_vel).

A contact pushes the harder the deeper it is: a robot that is spawned 6 cm deep in the floor, as
many launch files do, would leave it at 5 m/s. ODE bounds that speed (ODE manual,
dWorldSetContactMaxCorrectingVel), Bullet does not; so as long as something is so deep, all contacts
of the world correct only a small part of their depth in a step.
"""

from collections.abc import Callable, Sequence

from bullet_sim.physics.auto_disable import SimulatedBody
from bullet_sim.physics.quiet import pybullet

CORRECTED = 0.08  # part of the depth in each step; PyBullet's own, of rigid contacts
ALL = 1.0  # of it: what is no deeper separates at the engine's own velocity
FASTEST = 0.2  # m/s at which it separates
LONGEST = 5.0  # s, simulated, after which the engine has its own way again
DISTANCE = 8  # column of getContactPoints: m, below 0 where shapes overlap


class CorrectingVelocityLimit:
    """Looks at the depths before each step, from when a body was placed until none is deep.

    `run` runs a pybullet function in the engine; `bodies` is the list of all that are there.
    """

    def __init__(self, run: Callable, bodies: Sequence[SimulatedBody]):
        self._run = run
        self._bodies = bodies
        self._part: float | None = ALL  # that all bodies correct; None: one has come since
        self._left = 0.0  # s, for which to look on

    def watch(self) -> None:
        """A body was placed."""
        self._left, self._part = LONGEST, None

    def before_step(self, timestep: float) -> None:
        """Choose the part of the depth that the next step, of `timestep` (s), corrects."""
        if not self._left:
            return
        self._left = max(0.0, self._left - timestep)
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
        """Greatest depth of all contacts, m; 0 or less where nothing overlaps."""
        self._run(pybullet.performCollisionDetection)
        return max((-row[DISTANCE] for row in self._run(pybullet.getContactPoints)),
                   default=0.0)
