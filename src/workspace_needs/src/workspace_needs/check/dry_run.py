"""Runs robots and worlds in a simulation without a master, to collect what the plugins log."""

import logging
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from bullet_sim.description import ModelDescription, WorldDescription
from bullet_sim.formats.resources import Resources
from bullet_sim.meshes.images import warn_if_unreadable
from bullet_sim.plugin_tags import defaults
from bullet_sim.pose import IDENTITY
from bullet_sim.world import World
from bullet_sim_ros import loop
from bullet_sim_ros.interface import APPROXIMATED
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.plugin_host.unknown import log as unknown_plugins
from bullet_sim_ros.plugins import register_plugins
from bullet_sim_ros.services.models import with_namespace
from bullet_sim_ros.simulation import Simulation
from bullet_sim_ros.without_master import without_master
from workspace_needs.check.findings import PROBLEM

STEPS = 10  # enough for problems that only show when time passes
LOGGERS = ("bullet_sim", "rosout")
NOT_CAPTURED = (unknown_plugins.name, defaults.name)  # the former are looked up in the text
# Their warnings are about things that work differently; those of others, about missing things.
GO_ON = ("bullet_sim.plugins", "bullet_sim.control", "rosout", "bullet_sim.sensors",
         "bullet_sim.meshes.loading", "bullet_sim.formats.mistakes",
         "bullet_sim.formats.urdf.transmission")


@dataclass(frozen=True)
class LogLine:
    """A line of the log, and its status as a finding."""

    line: str
    status: str


class _Listener(logging.Handler):
    def __init__(self):
        super().__init__(logging.WARNING)
        self.captured: list[LogLine] = []

    def emit(self, record: logging.LogRecord) -> None:
        if record.name not in NOT_CAPTURED:
            self.captured.append(LogLine(record.getMessage(), _status(record)))


def _status(record: logging.LogRecord) -> str:
    goes_on = record.levelno < logging.ERROR and record.name.startswith(GO_ON)
    return APPROXIMATED if goes_on else PROBLEM


@contextmanager
def listening() -> Iterator[list[LogLine]]:
    """Collects the warnings of core and plugins meanwhile, and keeps them from the terminal."""
    listener, loggers = _Listener(), [logging.getLogger(name) for name in LOGGERS]
    propagated = [logger.propagate for logger in loggers]
    for logger in loggers:
        logger.propagate = False
        logger.addHandler(listener)
    try:
        yield listener.captured
    finally:
        for logger, before in zip(loggers, propagated, strict=True):
            logger.removeHandler(listener)
            logger.propagate = before


def try_model(description: ModelDescription, parameters: Mapping[str, object],
              namespace: str = "") -> None:
    """Spawn a model into an empty world, as spawn_model does; SimulationError if that fails.

    It gives each plugin a namespace, so that none takes the model's name, which may be no ROS name.
    """
    description = with_namespace(description, namespace or "/")
    _try(World(), parameters,
         lambda simulation: simulation.spawn(description, IDENTITY, description.name))


def try_world(description: WorldDescription, parameters: Mapping[str, object]) -> None:
    """Load a world with all its models and plugins, and take a few steps."""
    _try(World(description), parameters, lambda _simulation: None)


def _try(world: World, parameters: Mapping[str, object],
         fill: Callable[[Simulation], object]) -> None:
    """`parameters` are those that the parameter server would have, by full name."""
    register_plugins()
    with without_master() as graph:
        graph.parameters.update(parameters)
        simulation = Simulation(world, NodeParameters(enable_ros_network=False), Resources())
        try:
            fill(simulation)
            simulation.pacer.factor = 0.0
            loop.run(simulation, STEPS)
            for path in _textures(world):
                warn_if_unreadable(path)
        finally:
            for name in list(world.models):
                simulation.delete(name)  # ends the threads that wait for a parameter
            simulation.close()


def _textures(world: World) -> list[str]:
    """The texture files of the world's surfaces."""
    parts = [part for node in world.scene.nodes.values() for part in node.shape.parts]
    named = {part.material.texture for part in parts if part.uv is not None} - {None}
    return sorted(named - world.scene.images.keys())
