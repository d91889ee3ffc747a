"""From library file name to class, and the loading of all plugins of a model."""

from __future__ import annotations

import difflib
import logging
from collections.abc import Callable
from pathlib import PurePosixPath

from bullet_sim.model import Model
from bullet_sim_ros.errors import told
from bullet_sim_ros.plugins.host import Host, Shared

log = logging.getLogger("bullet_sim.plugins")

_registry: dict[str, Callable[[Host], object]] = {}
# Libraries that only make sense inside Gazebo's own process: nothing is missing without them.
_NOT_NEEDED = {"libgazebo_ros_api_plugin.so", "libgazebo_ros_paths_plugin.so"}


def plugin(*filenames: str) -> Callable[[type], type]:
    """Register a class under the library names that model files use."""
    def register(made: type) -> type:
        for filename in filenames:
            _registry[filename] = made
        return made
    return register


def load_plugins(shared: Shared, model: Model) -> list[Host]:
    """All plugins of a model and its sensors; one that fails is an error line, the rest goes on."""
    hosts = [Host(shared, model, description) for description in model.description.plugins]
    for link in model.links.values():
        for sensor in link.description.sensors:
            hosts += [Host(shared, model, made, sensor, link) for made in sensor.plugins]
    return [host for host in hosts if _load(host)]


def _load(host: Host) -> bool:
    """Make the plugin, which tells its host what to call when."""
    filename = PurePosixPath(host.description.filename).name
    if filename in _NOT_NEEDED:
        return False
    made = _registry.get(filename)
    if made is None:
        close = difflib.get_close_matches(filename, _registry, 1, cutoff=0.85)
        hint = f"; did you mean {close[0]}?" if close else ""
        log.warning("%s is not known here and has no effect%s", host.describe(), hint)
        return False
    try:
        made(host)
    except Exception as error:
        log.error("%s is not loaded: %s", host.describe(), told(error))
        host.close()
        return False
    return True
