"""An engine body's number and tree, and the engine's functions called with that number."""

import logging
import math

from bullet_sim.physics.assembly import Tree
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.engine import pybullet

log = logging.getLogger(__name__)

BASE = -1  # PyBullet's number of a body's base link


class EngineHandle:
    """The data through which the parts of a Body access the engine; the Body sets them."""

    tree: Tree
    number: int  # the engine's
    client: PhysicsClient  # of its engine
    index: dict[str, int]  # physics link -> the engine's number of it and of its joint
    joint_index: dict[str, int]  # of joints with one axis that can move in the engine
    ball_index: dict[str, int]  # of ball joints, which have no single angle
    _refused: set[str]  # quantities already reported as not finite

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

    def _is_number(self, what: str, *values: float) -> bool:
        """Whether they are finite: one NaN in the engine spreads to all bodies in contact."""
        if all(map(math.isfinite, values)):
            return True
        if what not in self._refused:
            self._refused.add(what)
            log.warning("%s: a %s of %s is not finite and is left out, here and from now on",
                        self.tree.links[-1].described, what, ", ".join(map(str, values)))
        return False
