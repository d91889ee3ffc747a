"""Recovery when a model's state is not finite: the model is reset, the world continues.

In the engine, one body with a NaN position makes all others fall through the ground.
"""

import logging
import math
from collections.abc import Iterable

from bullet_sim.model import Model
from bullet_sim.physics.body import Body
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.engine import EngineError

log = logging.getLogger(__name__)


def recover_from_nan(client: PhysicsClient, models: Iterable[Model]) -> None:
    """Reset models that are not finite to their spawn pose, and reload all others as they move."""
    client.auto_disable.found_nan = False
    models = list(models)
    broken = [model for model in models
              if not model.static and any(_is_broken(body) for body in model.bodies)]
    for model in broken:
        log.log(logging.DEBUG if model.has_recovered else logging.WARNING,
                "model %s: its pose or velocity is not finite; it is reset to its spawn pose. "
                "Look for forces, speeds or gains that are far too large, or masses that "
                "are far too small", model.name)
        model.has_recovered = True
    lost = {model.name: model.initial_pose for model in broken}
    lost |= {model.name: model.pose for model in models if model.static}  # may be affected
    for model in models:
        for body in model.bodies if model.name in lost else ():
            body.unload()
    for model in models:
        for body in model.bodies:
            if model.name in lost:
                body.load(lost[model.name] * body.base_pose_model)
            else:
                body.rebuild({})
    for model in models:
        model.reset() if model in broken else model.forget()


def lost_models(models: Iterable[Model], error: EngineError, logged: set[str]) -> list[str]:
    """After an error of the engine: the names of the models of which it has lost a body.

    Each is a line in the log; an error without such a cause is one, once: it goes into `logged`.
    """
    lost = [model.name for model in models if any(map(_is_lost, model.bodies))]
    for name in lost:
        log.error("model %s is deleted: the engine has lost its body (%s); the rest of the world "
                  "goes on", name, error)
    if not lost and str(error) not in logged:
        logged.add(str(error))
        log.error("an engine step failed: %s; the world goes on", error)
    return lost


def _is_lost(body: Body) -> bool:
    try:
        body.speeds()
        body.links.states()
    except EngineError:
        return True
    return False


def _is_broken(body: Body) -> bool:
    frame = body.links.base_frame()
    return math.isnan(sum((*body.speeds(), *frame.position, *frame.orientation)))
