"""The services of /gazebo by name; each handler registers itself."""

from collections.abc import Callable
from functools import partial
from typing import Any

from bullet_sim_ros.services.answers import offer
from bullet_sim_ros.simulation import Simulation

Handler = Callable[[Simulation, Any, Any], None]
_registry: list[tuple[str, type, Handler]] = []


def service(name: str, kind: type) -> Callable[[Handler], Handler]:
    """Register `handler(simulation, request, response)`, which fills the response in the loop."""
    def register(handler: Handler) -> Handler:
        _registry.append((name, kind, handler))
        return handler

    return register


def offer_registered(simulation: Simulation) -> None:
    """Advertise all that were registered."""
    for name, kind, handler in _registry:
        offer(simulation.mailbox, name, kind, partial(handler, simulation))
