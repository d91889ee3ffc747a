"""From library file name to class, and the loading of all plugins of a model."""

from __future__ import annotations

import difflib
import logging
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Protocol

from bullet_sim.description import PluginDescription, SensorDescription
from bullet_sim.errors import SimulationError
from bullet_sim.model import Link, Model
from bullet_sim.rendering.renderer import Renderer
from bullet_sim.world import World
from bullet_sim_ros.plugins.parameters import PluginError, PluginParameters

log = logging.getLogger("bullet_sim.plugins")


class Plugin(Protocol):
    """What the loop calls, in its own thread."""

    def update(self) -> None:
        """After each physics step."""

    def reset(self) -> None:
        """After reset_simulation."""

    def close(self) -> None:
        """The model goes away: end publishers and subscribers."""


@dataclass(frozen=True)
class Host:
    """What a plugin may use; `sensor` and `link` are set for sensor plugins only."""

    world: World
    model: Model
    description: PluginDescription
    renderer: Callable[[], Renderer]  # opened by the first camera
    leave: Callable[[Callable[[], None]], None]  # hands a call to the loop from a ROS thread
    sensor: SensorDescription | None = None
    link: Link | None = None

    @property
    def parameters(self) -> PluginParameters:
        """The plugin's tags."""
        return PluginParameters(self.model.name, self.description)


_registry: dict[str, Callable[[Host], Plugin]] = {}
# Tags that make sense only inside Gazebo's own process; silence is right for these.
_NOT_NEEDED = {"libgazebo_ros_api_plugin.so", "libgazebo_ros_paths_plugin.so"}


def plugin(*filenames: str) -> Callable[[type], type]:
    """Register a class under the library names that model files use."""
    def register(made: type) -> type:
        for filename in filenames:
            _registry[filename] = made
        return made
    return register


def load_plugins(host_for: Callable[..., Host], model: Model) -> list[Plugin]:
    """All plugins of a model and its sensors; one that fails is an error line, the rest goes on."""
    hosts = [host_for(model, description) for description in model.description.plugins]
    for link in model.links.values():
        for sensor in link.description.sensors:
            hosts += [host_for(model, made, sensor, link) for made in sensor.plugins]
    loaded = [_load(host) for host in hosts]
    return [made for made in loaded if made is not None]


def _load(host: Host) -> Plugin | None:
    filename = PurePosixPath(host.description.filename).name
    if filename in _NOT_NEEDED:
        return None
    made = _registry.get(filename)
    where = f"model {host.model.name}: plugin {host.description.name or '(no name)'} ({filename})"
    if made is None:
        close = difflib.get_close_matches(filename, _registry, 1, cutoff=0.85)
        hint = f"; did you mean {close[0]}?" if close else ""
        part = f"sensor {host.sensor.name} publishes nothing" if host.sensor else "it has no effect"
        log.warning("%s is not known here, %s%s", where, part, hint)
        return None
    try:
        return made(host)
    except (PluginError, SimulationError) as error:
        log.error("%s is not loaded: %s", where, error)
        return None
