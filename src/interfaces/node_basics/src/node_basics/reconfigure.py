"""Lets dynamic_reconfigure change a node's settings while it runs, without a .cfg file.

Type `rosrun dynamic_reconfigure dynparam list` to see the nodes that support it, and
`rosrun dynamic_reconfigure dynparam set NODE KEY VALUE` to change a number.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import Field, dataclass, fields, replace
from types import SimpleNamespace
from typing import Any, TypeVar

import rospy
from dynamic_reconfigure.server import Server

Settings = TypeVar("Settings")
TYPES = {float: "double", bool: "bool", int: "int", str: "str"}


@dataclass(frozen=True)
class Entry:
    """A value that can be changed, and its bounds; all of one type: float, bool, int or str."""

    name: str
    now: Any
    low: Any
    high: Any
    meaning: str


class EntryServer(Server):
    """Starts with the values that it is given, which have been read and checked.

    dynamic_reconfigure would read the parameter server again, where an integer gets another type.
    """

    def __init__(self, entries: Iterable[Entry], change: Callable[[dict, int], dict],
                 namespace: str = "", stores: bool = True):
        """`change` gets the values wanted, at once and in ROS's threads, and returns the new ones.

        Unless the server `stores` them on the parameter server, they last as long as the node.
        """
        self._stores = stores
        super().__init__(described(list(entries)), change, namespace)

    def _clamp(self, config: dict) -> None:
        wanted = dict(config)
        super()._clamp(config)
        for name, value in wanted.items():
            if config[name] != value:
                rospy.logwarn("dynamic_reconfigure: %s is now %s, not %s: it must be from %s to %s",
                              name, config[name], value, self.type.min[name], self.type.max[name])

    def _copy_from_parameter_server(self) -> None:
        """Does nothing."""

    def _copy_to_parameter_server(self) -> None:
        if self._stores:
            super()._copy_to_parameter_server()


def described(entries: list[Entry]) -> SimpleNamespace:
    """The description that a class generated from a .cfg file would have."""
    parameters = [{"name": entry.name, "type": TYPES[type(entry.now)], "level": 1,
                   "description": entry.meaning, "edit_method": "", "min": entry.low,
                   "max": entry.high} for entry in entries]
    return SimpleNamespace(
        defaults={entry.name: entry.now for entry in entries},
        min={entry.name: entry.low for entry in entries},
        max={entry.name: entry.high for entry in entries},
        config_description={"name": "Default", "type": "", "state": True, "id": 0, "parent": 0,
                            "parameters": parameters, "groups": []})


def serve_settings(settings: Settings, checked: Callable[[Field, object, str], object],
                   apply: Callable[[Settings], None]) -> Server:
    """Offer all numbers and switches of a dataclass, whose fields' metadata have `low`, `high` and
    `meaning`.

    `apply` gets the settings now and after each change, in ROS's threads. `checked(field, value,
    where)` returns the value or raises ValueError: that is a warning, and changes nothing. Changes
    are not stored: they would override the next run's file.
    """
    current = settings
    known = [entry for entry in fields(settings)
             if "low" in entry.metadata or entry.type in (bool, "bool")]

    def change(config: dict, _level: int) -> dict:
        nonlocal current
        try:
            current = replace(current, **{
                entry.name: checked(entry, config[entry.name], "dynamic_reconfigure")
                for entry in known})
        except ValueError as error:
            rospy.logwarn("%s", error)
        apply(current)
        config.update({entry.name: getattr(current, entry.name) for entry in known})
        return config

    return EntryServer([_entry(entry, getattr(settings, entry.name)) for entry in known], change,
                       stores=False)


def _entry(field: Field, now: float | bool) -> Entry:
    low, high = ((float(field.metadata["low"]), float(field.metadata["high"]))
                 if "low" in field.metadata else (False, True))
    return Entry(field.name, now, low, high, field.metadata["meaning"])
