"""From library file name to class, and the loading of all plugins of a model."""

from __future__ import annotations

import difflib
import logging
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Protocol

from bullet_sim.errors import SimulationError
from bullet_sim.model import Model
from bullet_sim_ros.plugins.host import Host, Shared
from bullet_sim_ros.plugins.parameters import PluginError

log = logging.getLogger("bullet_sim.plugins")


class Plugin(Protocol):
    """What the loop calls, in its own thread."""

    def update(self) -> None:
        """After each physics step."""

    def reset(self) -> None:
        """After reset_simulation."""


class Loaded:
    """A plugin at work, together with what it has opened."""

    def __init__(self, host: Host, plugin: Plugin):
        self._host = host
        self._plugin = plugin

    def update(self) -> bool:
        """Whether the plugin goes on: one that fails is closed with one error line."""
        return self._run(self._plugin.update)

    def reset(self) -> bool:
        """As `update`."""
        return self._run(self._plugin.reset)

    def close(self) -> None:
        """The model goes away."""
        self._host.close()

    def _run(self, method: Callable[[], None]) -> bool:
        try:
            method()
        except Exception as error:  # a plugin's fault must not take the simulation with it
            log.error("%s failed and is switched off: %s", self._host.describe(), told(error))
            self._host.close()
            return False
        return True


_registry: dict[str, Callable[[Host], Plugin]] = {}
# Libraries that only make sense inside Gazebo's own process: nothing is missing without them.
_NOT_NEEDED = {"libgazebo_ros_api_plugin.so", "libgazebo_ros_paths_plugin.so"}


def plugin(*filenames: str) -> Callable[[type], type]:
    """Register a class under the library names that model files use."""
    def register(made: type) -> type:
        for filename in filenames:
            _registry[filename] = made
        return made
    return register


def load_plugins(shared: Shared, model: Model) -> list[Loaded]:
    """All plugins of a model and its sensors; one that fails is an error line, the rest goes on."""
    hosts = [Host(shared, model, description) for description in model.description.plugins]
    for link in model.links.values():
        for sensor in link.description.sensors:
            hosts += [Host(shared, model, made, sensor, link) for made in sensor.plugins]
    loaded = [_load(host) for host in hosts]
    return [made for made in loaded if made is not None]


def told(error: Exception) -> str:
    """One line for the terminal; the kind of error where it is none of ours."""
    text = " ".join(str(error).split())
    known = isinstance(error, (PluginError, SimulationError))
    return text if known else f"{type(error).__name__}: {text}"


def _load(host: Host) -> Loaded | None:
    filename = PurePosixPath(host.description.filename).name
    if filename in _NOT_NEEDED:
        return None
    made = _registry.get(filename)
    if made is None:
        close = difflib.get_close_matches(filename, _registry, 1, cutoff=0.85)
        hint = f"; did you mean {close[0]}?" if close else ""
        log.warning("%s is not known here and has no effect%s", host.describe(), hint)
        return None
    try:
        return Loaded(host, made(host))
    except Exception as error:
        log.error("%s is not loaded: %s", host.describe(), told(error))
        host.close()
        return None
