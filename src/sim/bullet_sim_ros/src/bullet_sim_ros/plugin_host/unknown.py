"""The warning about an unknown plugin: once, with what will be missing."""

import logging
from collections.abc import Iterable

from bullet_sim.errors import did_you_mean
from bullet_sim_ros.plugin_host.context import PluginContext

log = logging.getLogger("bullet_sim.plugins.unknown")

# Beginnings of file names, and what is missing without these plugins. Gazebo's own plugins use its
# own transport, so ROS nodes do not depend on most of them.
CONSEQUENCES = {
    "libDiffDrivePlugin": "actuator: the wheels will not be driven; on ROS topics "
                          "libgazebo_ros_diff_drive.so does it",
    "libSkidSteerDrivePlugin": "actuator: the wheels will not be driven; on ROS topics "
                               "libgazebo_ros_skid_steer_drive.so does it",
    "libVehiclePlugin": "actuator: the vehicle will not be driven",
    "libLiftDragPlugin": "physics: no lift and no drag; what flies or sails by them will not",
    "libBuoyancyPlugin": "physics: no buoyancy; what floats or swims by it will sink",
    "librotors_gazebo": "actuator: rotors and what belongs to them; it will not fly",
    "libuuv_": "actuator or physics under water; it will not swim",
    "libusv_": "actuator or physics on water; it will not float",
    "libActorPlugin": "animation: the actor will not go its own way",
    "libKeysToJointsPlugin": "actuator: keys will not move the joints",
    "libFlashLightPlugin": "looks: the light will not blink",
    "libLedPlugin": "looks: the light will not blink",
    "libCameraPlugin": "no ROS topic is lost: it only uses Gazebo's own transport",
    "libDepthCameraPlugin": "no ROS topic is lost: it only uses Gazebo's own transport",
    "libRayPlugin": "no ROS topic is lost: it only uses Gazebo's own transport",
    "libImuSensorPlugin": "no ROS topic is lost: it only uses Gazebo's own transport",
}
# What is missing without any other plugin, by the element that it is in.
MATTERS = {
    "sensor": "sensor: its topics will be missing",
    "visual": "looks: what it shows will be missing",
    "model": "actuator or model plugin: what it moves will stand still, its topics will be missing",
    "world": "world plugin: what it does to the world will be missing, models are not touched",
}


def warn_of_unknown(context: PluginContext, filename: str, known: Iterable[str]) -> None:
    """One warning for each file name and model (or world)."""
    place = "" if context.kind == "world" else context.model.name
    if (place, filename) in context.host.warned:
        return
    context.host.warned.add((place, filename))
    log.warning("%s is not known here and left out; %s%s", context.describe(),
                consequence(context, filename), did_you_mean(filename, known, 0.85))


def consequence(context: PluginContext, filename: str) -> str:
    """What will be missing: by the name, else by the element that the plugin is in."""
    for beginning, text in CONSEQUENCES.items():
        if filename.startswith(beginning):
            return text
    return MATTERS[context.kind]
