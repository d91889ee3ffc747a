"""A node's own parameters: from a launch file or `_key:=value`, and changed while it runs.

`rosrun dynamic_reconfigure dynparam set NODE KEY VALUE` changes one; the settings' dataclass
replaces a .cfg file.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace

import rospkg
import rospy
from dynamic_reconfigure.server import Server
from rospy.client import load_command_line_node_params

from ai_robot_tracking.settings import Settings, SettingsError, checked, load_settings


def own_parameters() -> dict[str, object]:
    """By name, without `~`; those from the command line are deleted from the parameter server.

    SettingsError if a single value is in place of all of them.
    """
    given = rospy.get_param("~", {})
    if not isinstance(given, dict):
        raise SettingsError(f"the parameter {rospy.get_name()} is {given!r}: there should be "
                            f"parameters below it; type: rosparam delete {rospy.get_name()}")
    for key in load_command_line_node_params(sys.argv):
        rospy.delete_param(f"~{key}")  # _key:=value must not affect the next run
    return dict(given)


def read_settings(kind: type[Settings], section: str) -> Settings:
    """Settings from a section of config/tracking_params.yaml, or of the file in ~config.

    The node's other parameters override the file. If a value is invalid, exits with one line.
    """
    folder = Path(rospkg.RosPack().get_path("ai_robot_tracking"), "config")
    try:
        given = own_parameters()
        path = Path(str(given.pop("config", folder / "tracking_params.yaml")))
        return load_settings(kind, path, section, given)
    except SettingsError as error:
        rospy.logfatal("%s", error)
        sys.exit(1)


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
