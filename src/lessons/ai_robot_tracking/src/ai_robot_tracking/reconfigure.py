"""Settings that change while a node runs: `rosrun dynamic_reconfigure dynparam set NODE KEY VALUE`.

The settings' dataclass takes the place of a .cfg file.
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
    """Offer every number; `apply` gets all of them now and after each change, on ROS's threads.

    A number out of its bounds is a warning, and everything stays as it was.
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
    """Keeps off the parameter server: a change must not outlive the node and override its file."""

    def _copy_from_parameter_server(self) -> None:
        """The settings were read from there already."""

    def _copy_to_parameter_server(self) -> None:
        """Clients ask the node."""


def _described(settings: object) -> SimpleNamespace:
    """What a class made from a .cfg file would hold."""
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
