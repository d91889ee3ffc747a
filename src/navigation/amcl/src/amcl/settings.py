"""From the parameter table to the algorithm's settings."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import rospy

from nav_algorithms.monte_carlo import LocalisationSettings
from nav_algorithms.sensor_models import SensorSettings


def with_order(values: dict[str, Any]) -> dict[str, Any]:
    """The values with max_particles raised to min_particles if it is less, as upstream."""
    if values["min_particles"] <= values["max_particles"]:
        return values
    rospy.logwarn("~min_particles is %d and ~max_particles only %d: taken to be equal, %d",
                  values["min_particles"], values["max_particles"], values["min_particles"])
    return {**values, "max_particles": values["min_particles"]}


def localisation_settings(values: dict[str, Any]) -> LocalisationSettings:
    """Of the values by the names of the parameter table."""
    return LocalisationSettings(**{f.name: values[f.name] for f in fields(LocalisationSettings)})


def sensor_settings(values: dict[str, Any]) -> SensorSettings:
    """Of the values by the names of the parameter table."""
    return SensorSettings(**{f.name: values[f.name] for f in fields(SensorSettings)})
