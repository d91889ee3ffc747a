"""The plugin classes by library file name, and the loading of all plugins of a model."""

import logging
from collections.abc import Callable
from pathlib import PurePosixPath

from bullet_sim.description import SENSOR_TYPES, SensorDescription
from bullet_sim.errors import did_you_mean
from bullet_sim.model import Model
from bullet_sim.rendering.renderer import NoRenderer
from bullet_sim_ros.errors import format_error
from bullet_sim_ros.interface import documented
from bullet_sim_ros.plugin_host.context import PluginContext, PluginHost
from bullet_sim_ros.plugin_host.unknown import warn_of_unknown

log = logging.getLogger("bullet_sim.plugins")

_registry: dict[str, Callable[[PluginContext], object]] = {}
# Libraries that only make sense inside Gazebo's own process: nothing is missing without them.
NOT_NEEDED = {"libgazebo_ros_api_plugin.so", "libgazebo_ros_paths_plugin.so"}


def plugin(*filenames: str) -> Callable[[type], type]:
    """Register a class under the library names that model files use.

    It is called with a PluginContext; a PluginError that it raises is logged as one line.
    """
    def register(made: type) -> type:
        for filename in filenames:
            _registry[filename] = made
        return made
    return register


def load_plugins(host: PluginHost, model: Model) -> list[PluginContext]:
    """All plugins of a model, its sensors and visuals; one that fails is one error line.

    NoRenderer if it has a camera, and none can be drawn on this machine.
    """
    contexts = [
        PluginContext(host, model, description) for description in model.description.plugins
    ]
    for link in model.links.values():
        for sensor in link.description.sensors:
            warn_of_sensor(model.name, sensor)
            contexts += [
                PluginContext(host, model, made, sensor, link) for made in sensor.plugins
            ]
        for visual in link.description.visuals:
            contexts += [PluginContext(host, model, made, link=link, visual=visual)
                         for made in visual.plugins]
    loaded = []
    try:
        for context in contexts:
            if _load(context):
                loaded.append(context)
    except NoRenderer:
        for context in loaded:
            context.close()
        raise
    return loaded


def load_world_plugins(host: PluginHost) -> list[PluginContext]:
    """The plugins of the `<world>` itself."""
    contexts = [PluginContext(host, None, description)
                for description in host.world.description.plugins]
    return [context for context in contexts if _load(context)]


def _load(context: PluginContext) -> bool:
    """Create the plugin, which registers its callbacks with its context; False if there is none."""
    filename = PurePosixPath(context.description.filename).name
    if filename in NOT_NEEDED:
        return False
    made = _registry.get(filename)
    if made is None:
        warn_of_unknown(context, filename, _registry)
        return False
    try:
        made(context)
    except NoRenderer:
        context.close()
        raise
    except Exception as error:
        log.error("%s is not loaded: %s", context.describe(), format_error(error))
        context.close()
        return False
    warn_of_unread_tags(context)
    return True


# Robots carry these in plugins of any kind, whether or not the plugin reads them.
EVERY_PLUGIN = frozenset(("robotNamespace", "alwaysOn", "always_on", "updateRate", "update_rate",
                          "visualize", "plugin"))


def warn_of_unread_tags(context: PluginContext) -> None:
    """One warning for each tag that the plugin has not read and the interface table does not list.

    Tags in the table that have no effect, or are read later, cause no warning.
    """
    unread = [tag for tag in context.parameters.unread() if tag not in EVERY_PLUGIN]
    if not unread:
        return
    row = documented().get(PurePosixPath(context.description.filename).name)
    known = set(row.tags) if row else set()
    for tag in unread:
        if tag not in known:
            names = sorted(map(_inner, known | context.parameters.read))
            log.warning("%s: <%s> is ignored, as by Gazebo: the plugin has no such tag%s",
                        context.describe(), _inner(tag),
                        did_you_mean(_inner(tag), names, 0.75, "<{}>"))


def _inner(path: str) -> str:
    """`a><b` of `a/b`."""
    return path.replace("/", "><")


# Gazebo simulates these, but no plugin of gazebo_plugins brings them to ROS.
GAZEBO_ONLY = ("logical_camera", "rfid", "rfidtag", "sonar", "wireless_receiver",
               "wireless_transmitter", "altimeter", "magnetometer", "gps", "air_pressure")


def warn_of_sensor(model: str, sensor: SensorDescription) -> None:
    """One line for a sensor whose type is not simulated, unless a plugin simulates it."""
    if sensor.type in SENSOR_TYPES or (sensor.type in GAZEBO_ONLY and sensor.plugins):
        return
    if sensor.type in GAZEBO_ONLY:
        log.warning("model %s: sensor %s: type %s is not simulated; without a plugin it has no ROS "
                    "topic in Gazebo either", model, sensor.name, sensor.type)
        return
    log.error("model %s: sensor %s: there is no type %r; there are %s", model, sensor.name,
              sensor.type, ", ".join((*SENSOR_TYPES, *GAZEBO_ONLY)))
