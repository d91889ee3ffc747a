"""Changes settings while a node runs: `rosrun dynamic_reconfigure dynparam set NODE KEY VALUE`.

The settings' dataclass replaces a .cfg file.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from types import SimpleNamespace
from typing import TypeVar

import rospy
from dynamic_reconfigure.server import Server

from ai_robot_tracking.settings import SettingsError, checked

Settings = TypeVar("Settings")


def offer_settings(settings: Settings, apply: Callable[[Settings], None]) -> Server:
    """Offer all numbers; `apply` gets them now and after each change, in ROS's threads.

    A number outside its bounds causes a warning and changes nothing.
    """
    current = settings

    def change(config: dict, _level: int) -> dict:
        nonlocal current
        try:
            current = replace(current, **{
                entry.name: checked(entry, config[entry.name],
                                    f"dynamic_reconfigure: '{entry.name}'")
                for entry in fields(settings)})
        except SettingsError as error:
            rospy.logwarn("%s", error)
        apply(current)
        for entry in fields(settings):
            config[entry.name] = getattr(current, entry.name)
        return config

    return _Forgetful(_described(settings), change)


class _Forgetful(Server):
    """Does not use the parameter server: a change must not override the next run's file."""

    def _copy_from_parameter_server(self) -> None:
        """Not needed: the settings were already read."""

    def _copy_to_parameter_server(self) -> None:
        """Not needed: clients ask the node."""


def _described(settings: object) -> SimpleNamespace:
    """The description that a class generated from a .cfg file would have."""
    entries = [{"name": entry.name, "type": "double", "level": 0, "edit_method": "",
                "description": entry.metadata["meaning"], "min": float(entry.metadata["low"]),
                "max": float(entry.metadata["high"])} for entry in fields(settings)]

    def column(key: str) -> dict:
        return {entry["name"]: entry[key] for entry in entries}

    return SimpleNamespace(
        defaults={entry.name: getattr(settings, entry.name) for entry in fields(settings)},
        min=column("min"), max=column("max"), level=column("level"), type=column("type"),
        all_level=0,
        config_description={"name": "Default", "type": "", "state": True, "id": 0, "parent": 0,
                            "parameters": entries, "groups": []})
