"""The warning about a sensor that nothing here reads."""

import logging

from bullet_sim.description import SENSOR_TYPES, SensorDescription

log = logging.getLogger("bullet_sim.plugins")

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
