"""Lets dynamic_reconfigure change a node's settings while it runs, without a .cfg file.

Type `rosrun dynamic_reconfigure dynparam list` to see the nodes that support it, and
`rosrun dynamic_reconfigure dynparam set NODE KEY VALUE` to change a number.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import Field, replace
from types import SimpleNamespace
from typing import TypeVar

import rospy
from dynamic_reconfigure.server import Server

from car_control.settings import SettingsError, changeable, checked

Settings = TypeVar("Settings")


def serve_settings(settings: Settings, apply: Callable[[Settings], None]) -> Server:
    """Offer all numbers and switches; `apply` gets the settings now and after each change.

    `apply` runs in ROS's threads. An invalid value causes a warning and changes nothing.
    """
    current = settings

    def change(config: dict, _level: int) -> dict:
        nonlocal current
        try:
            wanted = {
                entry.name: checked(entry, config[entry.name], "dynamic_reconfigure")
                for entry in changeable(type(settings))
            }
            current = replace(current, **wanted)
        except (SettingsError, ValueError) as error:
            rospy.logwarn("%s", error)
        apply(current)
        for entry in changeable(type(settings)):
            config[entry.name] = getattr(current, entry.name)
        return config

    return _UnstoredServer(describe(settings), change)


class _UnstoredServer(Server):
    """Does not use the parameter server: values there would override the next run's file.

    dynamic_reconfigure's clients only use the server's topics and its service.
    """

    def _copy_from_parameter_server(self) -> None:
        """Not needed: the settings were already read, and this would change numbers' types."""

    def _copy_to_parameter_server(self) -> None:
        """Not done: a change only lasts as long as the node, however that ends."""


def describe(settings: object) -> SimpleNamespace:
    """The description that a class generated from a .cfg file would have."""
    parameters = [_parameter(entry) for entry in changeable(type(settings))]
    return SimpleNamespace(
        defaults={p["name"]: getattr(settings, p["name"]) for p in parameters},
        min={p["name"]: p["min"] for p in parameters},
        max={p["name"]: p["max"] for p in parameters},
        level={p["name"]: p["level"] for p in parameters},
        type={p["name"]: p["type"] for p in parameters},
        all_level=0,
        config_description={
            "name": "Default",
            "type": "",
            "state": True,
            "id": 0,
            "parent": 0,
            "parameters": parameters,
            "groups": [],
        },
    )


def _parameter(entry: Field) -> dict:
    number = "low" in entry.metadata
    return {
        "name": entry.name,
        "type": "double" if number else "bool",
        "level": 0,
        "description": entry.metadata["meaning"],
        "edit_method": "",
        "min": entry.metadata["low"] if number else False,
        "max": entry.metadata["high"] if number else True,
    }
