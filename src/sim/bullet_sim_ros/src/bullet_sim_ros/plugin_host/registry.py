"""From library file name to class, and the loading of all plugins of a model."""

import logging
from collections.abc import Callable
from pathlib import PurePosixPath

from bullet_sim.model import Model
from bullet_sim_ros.errors import format_error
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.sensor_types import warn_of_sensor
from bullet_sim_ros.plugin_host.shared_by_plugins import SharedByPlugins
from bullet_sim_ros.plugin_host.unknown import warn_of_unknown
from bullet_sim_ros.plugin_host.unread_tags import warn_of_unread_tags

log = logging.getLogger("bullet_sim.plugins")

_registry: dict[str, Callable[[PluginContext], object]] = {}
# Libraries that only make sense inside Gazebo's own process: nothing is missing without them.
NOT_NEEDED = {"libgazebo_ros_api_plugin.so", "libgazebo_ros_paths_plugin.so"}


def plugin(*filenames: str) -> Callable[[type], type]:
    """Register a class under the library names that model files use.

    It is made with a PluginContext; a PluginError then, of a wrong tag, is one line of the log.
    """
    def register(made: type) -> type:
        for filename in filenames:
            _registry[filename] = made
        return made
    return register


def load_plugins(services: SharedByPlugins, model: Model) -> list[PluginContext]:
    """All plugins of a model, its sensors and visuals; one that fails is one error line."""
    contexts = [
        PluginContext(services, model, description) for description in model.description.plugins
    ]
    for link in model.links.values():
        for sensor in link.description.sensors:
            warn_of_sensor(model.name, sensor)
            contexts += [
                PluginContext(services, model, made, sensor, link) for made in sensor.plugins
            ]
        for visual in link.description.visuals:
            contexts += [PluginContext(services, model, made, link=link, visual=visual)
                         for made in visual.plugins]
    return [context for context in contexts if _load(context)]


def load_world_plugins(services: SharedByPlugins) -> list[PluginContext]:
    """The plugins of the `<world>` itself."""
    contexts = [PluginContext(services, None, description)
                for description in services.world.description.plugins]
    return [context for context in contexts if _load(context)]


def _load(context: PluginContext) -> bool:
    """Make the plugin, which registers with its context what to call when."""
    filename = PurePosixPath(context.description.filename).name
    if filename in NOT_NEEDED:
        return False
    made = _registry.get(filename)
    if made is None:
        warn_of_unknown(context, filename, _registry)
        return False
    try:
        made(context)
    except Exception as error:
        log.error("%s is not loaded: %s", context.describe(), format_error(error))
        context.close()
        return False
    warn_of_unread_tags(context)
    return True
