"""Joint controllers by the type that YAML files name, and their base class."""

from __future__ import annotations

from collections.abc import Callable

from bullet_sim.errors import did_you_mean
from bullet_sim_ros.control.controller_context import ControllerContext

BASE_CLASS = "controller_interface::ControllerBase"

_registry: dict[str, type[Controller]] = {}


class Controller:
    """Created in a ROS thread when loaded; started, updated and stopped in the loop's thread.

    `__init__` reads parameters, claims joints and opens topics, and raises a SimulationError whose
    message says what is wrong. Time and period are in simulated seconds.
    """

    def __init__(self, context: ControllerContext):
        self.context = context

    def start(self, time: float) -> None:
        """Called before the first update; also after an emergency stop was released."""

    def update(self, time: float, period: float) -> None:
        """Read joints, write commands; `period` is the time since the last update."""

    def stop(self, time: float) -> None:
        """Called after the last update; then the manager puts every claimed command to rest."""


def controller(*types: str) -> Callable[[type], type]:
    """Register a class under type strings such as `effort_controllers/JointPositionController`."""
    def register(made: type) -> type:
        for kind in types:
            _registry[kind] = made
        return made
    return register


def find(kind: str) -> type[Controller] | None:
    """The class of a type; None for an unknown type."""
    return _registry.get(kind)


def types() -> list[str]:
    """All types, sorted."""
    return sorted(_registry)


def hint(kind: str) -> str:
    """The end of an error line: the type that was probably meant, if one is similar."""
    return did_you_mean(kind, _registry, 0.6)
