"""From library file name to class, and the loading of all plugins of a model."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import PurePosixPath

from bullet_sim.model import Model
from bullet_sim_ros.errors import told
from bullet_sim_ros.plugin_host.context import Host
from bullet_sim_ros.plugin_host.sensor_types import warn_of_sensor
from bullet_sim_ros.plugin_host.services import Shared
from bullet_sim_ros.plugin_host.unknown import warn_of_unknown

log = logging.getLogger("bullet_sim.plugins")

_registry: dict[str, Callable[[Host], object]] = {}
# Libraries that only make sense inside Gazebo's own process: nothing is missing without them.
NOT_NEEDED = {"libgazebo_ros_api_plugin.so", "libgazebo_ros_paths_plugin.so"}


def plugin(*filenames: str) -> Callable[[type], type]:
    """Register a class under the library names that model files use."""
    def register(made: type) -> type:
        for filename in filenames:
            _registry[filename] = made
        return made
    return register


def load_plugins(shared: Shared, model: Model) -> list[Host]:
    """All plugins of a model, its sensors and visuals; one that fails is one error line."""
    hosts = [Host(shared, model, description) for description in model.description.plugins]
    for link in model.links.values():
        for sensor in link.description.sensors:
            warn_of_sensor(model.name, sensor)
            hosts += [Host(shared, model, made, sensor, link) for made in sensor.plugins]
        for visual in link.description.visuals:
            hosts += [Host(shared, model, made, link=link, visual=visual)
                      for made in visual.plugins]
    return [host for host in hosts if _load(host)]


def load_world_plugins(shared: Shared) -> list[Host]:
    """The plugins that stand in the `<world>` itself."""
    hosts = [Host(shared, None, plugin) for plugin in shared.world.description.plugins]
    return [host for host in hosts if _load(host)]


def _load(host: Host) -> bool:
    """Make the plugin, which tells its host what to call when."""
    filename = PurePosixPath(host.description.filename).name
    if filename in NOT_NEEDED:
        return False
    made = _registry.get(filename)
    if made is None:
        warn_of_unknown(host, filename, _registry)
        return False
    try:
        made(host)
    except Exception as error:
        log.error("%s is not loaded: %s", host.describe(), told(error))
        host.close()
        return False
    return True
