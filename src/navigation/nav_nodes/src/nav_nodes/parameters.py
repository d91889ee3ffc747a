"""A node's parameters by a table in a YAML file: read once, checked, changed at run time.

A table is a list of entries with `name`, `type` (bool, int, double, str, list), `default`,
`meaning`, and optionally `min`, `max` (numbers), `choices` (str), `also` (names that upstream also
reads, if `name` is not set), `was` (older names that are not read), `change` (true: offered by
dynamic_reconfigure), `status` (works; accepted: no effect; differs: has another meaning than in
upstream), `ours` (true: not in upstream, and the default does what upstream does).
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import rospy
import yaml
from dynamic_reconfigure.server import Server
from node_basics.reconfigure import Entry, EntryServer

KINDS = {"bool": bool, "int": int, "double": float, "str": str, "list": list}


class ParameterError(ValueError):
    """An invalid parameter; the text names it, its value, and what is allowed."""


@dataclass(frozen=True)
class Parameter:
    """One line of a table."""

    name: str
    type: str
    default: Any
    min: float = -math.inf
    max: float = math.inf
    choices: tuple[str, ...] = ()
    also: tuple[str, ...] = ()
    was: tuple[str, ...] = ()
    change: bool = False
    status: str = "works"
    ours: bool = False
    meaning: str = ""

    def checked(self, value: Any, where: str) -> Any:
        """The value in this entry's type; raises ParameterError with `where` it was set."""
        kind, shown = KINDS[self.type], reprlib.repr(value)[:80]
        if kind is float and type(value) is int and abs(value) < 1e300:
            value = float(value)
        if kind is int and isinstance(value, float) and value.is_integer():
            value = int(value)  # roscpp accepts 20.0 for 20, too
        if kind is str and isinstance(value, list):  # [[0.1, 0.1], ...]: a string in upstream
            value = yaml.safe_dump(value, default_flow_style=True, width=math.inf).strip()
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            raise ParameterError(f"{where} is {shown}, but must be of type {self.type}")
        if kind in (int, float) and not self.min <= value <= self.max:
            raise ParameterError(f"{where} is {shown}, but must be {self._range()}")
        if self.choices and value not in self.choices:
            raise ParameterError(f"{where} is {shown}, but must be {' or '.join(self.choices)}")
        return value

    def _range(self) -> str:
        if self.max == math.inf:
            return "a number" if self.min == -math.inf else f"at least {self.min:g}"
        return f"between {self.min:g} and {self.max:g}"


def load_table(path: Path) -> list[Parameter]:
    """The table in a file; raises ParameterError that names file and key of an error."""
    known = {field.name for field in fields(Parameter)}
    table = []
    for entry in yaml.safe_load(path.read_text(encoding="utf-8")):
        strange = entry.keys() - known
        if strange or entry["type"] not in KINDS:
            raise ParameterError(f"{path}: {entry['name']}: unknown key or type: "
                                 f"{', '.join(sorted(strange)) or entry['type']}")
        for key in ("choices", "also", "was"):
            entry[key] = tuple(entry.get(key, ()))
        table.append(Parameter(**entry))
        table[-1].checked(table[-1].default, f"{path}: default of {table[-1].name}")
    return table


def read_parameters(table: list[Parameter], namespace: str = "~") -> dict[str, Any]:
    """Every parameter of the table by name, from the parameter server below `namespace`.

    Raises ParameterError for one of the wrong type or out of its range.
    """
    values = {}
    for entry in table:
        name = _name_on_server(entry, namespace)
        values[entry.name] = entry.checked(rospy.get_param(name, entry.default), name)
    return values


def _name_on_server(entry: Parameter, namespace: str) -> str:
    """The entry's name, or one of its `also` names that is set while that is not."""
    names = [rospy.resolve_name(namespace + name) for name in (entry.name, *entry.also)]
    return next((name for name in names[1:] if rospy.has_param(name)
                 and not rospy.has_param(names[0])), names[0])


def serve_changes(table: list[Parameter], values: dict[str, Any],
                  apply: Callable[[dict[str, Any]], dict[str, Any] | None],
                  namespace: str = "") -> Server:
    """Offer the changeable entries by dynamic_reconfigure below `~namespace`.

    `apply` gets all values, now and after each change, on ROS's threads, and may return values to
    use instead; if it raises ParameterError, that is logged as a warning and nothing changes.
    `restore_defaults`, if in the table, restores the values from the start, as upstream.
    """
    changeable = [entry for entry in table if entry.change]
    current = dict(values)

    def change(config: dict, _level: int) -> dict:
        wanted = {**current, **{entry.name: config[entry.name] for entry in changeable}}
        if wanted.get("restore_defaults"):
            wanted = {**values, "restore_defaults": False}
        try:
            for entry in changeable:
                entry.checked(wanted[entry.name], f"dynamic_reconfigure: {entry.name}")
            current.update(apply(dict(wanted)) or wanted)
        except ParameterError as error:
            rospy.logwarn("%s", error)
        for entry in changeable:
            config[entry.name] = current[entry.name]
        return config

    return EntryServer([Entry(entry.name, current[entry.name], _bound(entry, entry.min),
                              _bound(entry, entry.max), entry.meaning) for entry in changeable],
                       change, namespace)


def _bound(entry: Parameter, bound: float) -> Any:
    """A bound in the entry's own type, as the message needs it."""
    if entry.type == "bool":
        return bound > 0
    if entry.type == "str":
        return ""
    if entry.type == "int":
        return int(max(-2**31, min(2**31 - 1, bound)))
    return float(max(-1e9, min(1e9, bound)))
