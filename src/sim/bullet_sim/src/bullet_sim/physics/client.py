"""One PyBullet world: connection, engine parameters, a quiet importer, and a body in it."""

import logging
import math
import tempfile
from pathlib import Path
from typing import Protocol

from bullet_sim.description import PhysicsDescription
from bullet_sim.errors import SimulationError
from bullet_sim.physics.assembly import Tree
from bullet_sim.physics.auto_disable import AutoDisable
from bullet_sim.physics.correcting_velocity import CorrectingVelocityLimit
from bullet_sim.physics.crowding import Crowding
from bullet_sim.physics.engine import STDOUT, EngineError, pybullet, quiet
from bullet_sim.physics.island_sleeping import IslandSleeping
from bullet_sim.physics.planes import Planes
from bullet_sim.physics.urdf_text import STATIC_FILTER, MeshFiles, urdf_text
from bullet_sim.pose import Pose, Vector3

log = logging.getLogger(__name__)

BASE = -1  # PyBullet's number of a body's base link
NOWHERE = -1  # the number of a body that is not in the engine

LOAD_FLAGS = (
    pybullet.URDF_USE_INERTIA_FROM_FILE
    # The default cylinder is a 32-sided prism plus a margin: wheels would roll 3 % too far.
    | pybullet.URDF_USE_IMPLICIT_CYLINDER
    | pybullet.URDF_MAINTAIN_LINK_ORDER
)

# With SDF's default of 50, a light driven wheel is not solved fully: a robot driving straight began
# to turn after 8 s. 150, the value in the courses' worlds, holds 0.15 m/s within 0.05 %.
FEWEST_ITERATIONS = 150
# The solver stops once no row of an iteration changes by more than the root of this, m^2/s^2 (or
# rad^2/s^2), unless the world says what else. EXACT is the engine's own. FAST, 3 mm/s, is for
# worlds in which something is fast that does not roll on held wheels: a box at rest on a slope
# meanwhile creeps at 0.13 mm/s.
EXACT, FAST = 1e-7, 1e-5
FREE_GROUPS = tuple(1 << bit for bit in range(24, 31))  # past those of <collide_bitmask>
PLACING = (pybullet.loadURDF, pybullet.resetBasePositionAndOrientation)


class SettlingWheels(Protocol):
    """A body's wheels, of which some were commanded (`physics.held_wheels.HeldWheels`)."""

    def after_step(self) -> None:
        """Hold those that have turned as told for some steps."""
        ...


class PhysicsClient:
    """Owns one engine instance: all others reach PyBullet through its methods."""

    def __init__(self, physics: PhysicsDescription, gravity: Vector3):
        self.auto_disable = AutoDisable()
        self.planes = Planes(self._let_collide)
        self.crowding = Crowding(self.read)
        self.free_groups = list(FREE_GROUPS)  # for models of many loose links
        bodies, run = self.auto_disable.bodies, self.change_without_waking
        self._correcting_velocity = CorrectingVelocityLimit(run, bodies)
        self._island_sleeping = IslandSleeping(run, bodies)
        self.settling: dict[SettlingWheels, None] = {}  # of bodies that were commanded
        self.retro: dict[tuple[int, int], float] = {}  # laser_retro of engine links, where not 0
        self._id = pybullet.connect(pybullet.DIRECT)
        self.configure(physics, gravity)

    def configure(self, physics: PhysicsDescription, gravity: Vector3) -> None:
        """Step (s), solver iterations and gravity (m/s^2)."""
        self.change(
            pybullet.setPhysicsEngineParameter,
            fixedTimeStep=physics.max_step_size,
            numSubSteps=0,
            numSolverIterations=max(physics.iterations, FEWEST_ITERATIONS),
            solverResidualThreshold=physics.residual or EXACT,
            # A pyramid, SDF's default <friction_model>. With a cone light driven wheels creep:
            # a turn in place was 8 % slow.
            enableConeFriction=0,
            deterministicOverlappingPairs=1,
            enableFileCaching=0,
        )
        self.change(pybullet.setGravity, *gravity)
        self.residual = physics.residual
        self._tolerance: float | None = None  # the next step sets it, and inertias
        self.timestep = physics.max_step_size  # s
        self.surface_layer = physics.contact_surface_layer  # m
        self.auto_disable.set_step(physics.max_step_size)

    def change(self, function, *args, **kwargs):
        """Run a pybullet function that changes something; a world at rest is stepped again."""
        self.auto_disable.wake()
        if self._island_sleeping.changed(function, args) or function in PLACING:
            self._correcting_velocity.watch()
        return function(*args, physicsClientId=self._id, **kwargs)

    def change_without_waking(self, function, *args, **kwargs):
        """Run a pybullet function that changes something, in a world that may stay at rest.

        For effects in every step, such as springs, and for changes that are undone at once.
        """
        return function(*args, physicsClientId=self._id, **kwargs)

    def read(self, function, *args, **kwargs):
        """Run a pybullet function that changes nothing."""
        return function(*args, physicsClientId=self._id, **kwargs)

    def step(self) -> None:
        """Advance the engine by one fixed step, unless it would change nothing."""
        if self.auto_disable.step_needed():
            tolerance = self.residual or (FAST if self.auto_disable.is_fast else EXACT)
            if tolerance != self._tolerance:
                self._tolerance = tolerance
                self.change_without_waking(pybullet.setPhysicsEngineParameter,
                                           solverResidualThreshold=tolerance)
                for body in self.auto_disable.bodies:
                    body.wheels.update_inertia()
            self._correcting_velocity.before_step(self.timestep)
            pybullet.stepSimulation(physicsClientId=self._id)
            if self.settling:
                for wheels in list(self.settling):
                    wheels.after_step()
            self._island_sleeping.after_step(self.auto_disable.is_sampling)
            if self.auto_disable.nearly_disabled:
                for body in self.auto_disable.bodies:
                    body.joints.keep_feedback()

    def load(self, tree: Tree, pose: Pose) -> int:
        """Load a body from a tree; returns its number. The importer's output is suppressed.

        SimulationError if the engine rejects it.
        """
        flags = LOAD_FLAGS
        if tree.self_collide:
            flags |= pybullet.URDF_USE_SELF_COLLISION
        with tempfile.TemporaryDirectory(prefix="bullet_sim-") as folder:
            path = Path(folder) / "body.urdf"
            path.write_text(urdf_text(tree.links, MeshFiles(Path(folder))), encoding="utf-8")
            try:
                with quiet(STDOUT):
                    return self.change(
                        pybullet.loadURDF, str(path), pose.position, pose.orientation,
                        useFixedBase=tree.fixed, flags=flags,
                    )
            except EngineError as error:
                raise SimulationError(f"the engine rejects link {tree.links[0].described} and the "
                                      f"links below it: {error}") from None

    def _let_collide(self, body: int, on: bool) -> None:
        group, mask = STATIC_FILTER if on else (0, 0)
        self.change(pybullet.setCollisionFilterGroupMask, body, -1, group, mask)

    def close(self) -> None:
        """Disconnect; the client must not be used afterwards."""
        pybullet.disconnect(physicsClientId=self._id)


class EngineBody:
    """A body's number and tree, and the engine's functions called with that number."""

    def __init__(self, client: PhysicsClient, tree: Tree):
        self.client = client
        self.tree = tree
        self.number = NOWHERE
        self._refused: set[str] = set()  # quantities already reported as not finite

    def change(self, function, *args, **kwargs):
        """Run a pybullet function that changes this body; the world is stepped again."""
        return self.client.change(function, self.number, *args, **kwargs)

    def change_without_waking(self, function, *args, **kwargs):
        """The same for effects in every step: a world at rest stays at rest."""
        return self.client.change_without_waking(function, self.number, *args, **kwargs)

    def read(self, function, *args, **kwargs):
        """Run a pybullet function that reads this body's state."""
        return self.client.read(function, self.number, *args, **kwargs)

    def dynamics(self, index: int) -> tuple:
        """PyBullet's row of a link: mass, friction, principal inertia, centre of mass ..."""
        return self.read(pybullet.getDynamicsInfo, index)

    def is_number(self, what: str, *values: float) -> bool:
        """Whether they are finite: one NaN in the engine spreads to all bodies in contact."""
        if all(map(math.isfinite, values)):
            return True
        if what not in self._refused:
            self._refused.add(what)
            log.warning("%s: a %s of %s is not finite and is left out, here and from now on",
                        self.tree.links[-1].described, what, ", ".join(map(str, values)))
        return False
