"""An engine body's number and tree, and the engine's functions called with that number."""

from __future__ import annotations

import logging
import math

from bullet_sim.physics.assembly import Tree
from bullet_sim.physics.client import PhysicsClient

log = logging.getLogger(__name__)


class EngineHandle:
    """What both sides of a Body, links and joints, reach the engine by; the Body fills it in."""

    tree: Tree
    number: int  # the engine's
    _client: PhysicsClient
    _index: dict[str, int]  # physics link -> the engine's number of it and of its joint
    _refused: set[str]  # what has been said to be no number

    def _call(self, function, *args, **kwargs):
        return self._client.call(function, self.number, *args, **kwargs)

    def _read(self, function, *args, **kwargs):
        return self._client.read(function, self.number, *args, **kwargs)

    def _is_number(self, what: str, *values: float) -> bool:
        """Whether the engine may see them: one NaN, and nothing has ground to stand on."""
        if all(map(math.isfinite, values)):
            return True
        if what not in self._refused:
            self._refused.add(what)
            log.warning("%s: a %s of %s is no number and is left out, here and from now on",
                        self.tree.links[-1].described, what, ", ".join(map(str, values)))
        return False
