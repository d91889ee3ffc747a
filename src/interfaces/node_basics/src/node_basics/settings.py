"""A node's settings: a dataclass filled from a YAML file, overridden by ROS parameters.

The YAML file has all defaults; the dataclass has types, bounds and meanings.
"""

from __future__ import annotations

import reprlib
from collections.abc import Mapping
from dataclasses import Field, field, fields
from pathlib import Path
from typing import Any, TypeVar

from node_basics.records import check_keys, read_yaml

Settings = TypeVar("Settings")


class SettingsError(ValueError):
    """One line that names the file (or parameters), the key, and the error."""


def number(low: float, high: float, meaning: str) -> Any:
    """A field of type float within these bounds; the meaning has its unit."""
    return field(metadata={"low": float(low), "high": float(high), "meaning": meaning})


def count(low: int, high: int, meaning: str) -> Any:
    """A field of type int within these bounds."""
    return field(metadata={"low": low, "high": high, "meaning": meaning})


def choice(*names: str) -> Any:
    """A field of type str: one of these words."""
    return field(metadata={"names": names, "meaning": f"one of {', '.join(names)}"})


def explained(meaning: str) -> Any:
    """A field of type bool or str."""
    return field(metadata={"meaning": meaning})


def load_settings(kind: type[Settings], path: str | Path, section: str | None = None,
                  given: Mapping[str, object] | None = None) -> Settings:
    """An instance of the dataclass `kind` from a file's table.

    section: the table's key in the file, None for the whole file. Keys in `given`, the node's own
    ROS parameters, take precedence. Any error is a SettingsError.
    """
    in_file, in_node = f"{path}: {section}" if section else str(path), "the node's parameters"
    known = {entry.name: entry for entry in fields(kind)}
    values = _table(Path(path), section, in_file)
    check_keys(in_file, values, known, SettingsError)
    given = given or {}
    check_keys(in_node, dict.fromkeys(known) | dict(given), known, SettingsError)
    found = {name: checked(entry, values[name], in_file) for name, entry in known.items()}
    found |= {name: checked(known[name], value, in_node) for name, value in given.items()}
    try:
        return kind(**found)
    except ValueError as error:  # the dataclass's own check of its values' combination
        raise SettingsError(f"{in_file} and the node's parameters: {error}") from error


def checked(entry: Field, value: object, where: str) -> Any:
    """The value as this field's type; SettingsError if it is invalid."""
    rule, kind = entry.metadata, _type_name(entry)
    if "names" in rule:
        fits, wanted = value in rule["names"], rule["meaning"]
    elif "low" in rule:
        allowed = int if kind == "int" else int | float
        fits = (isinstance(value, allowed) and not isinstance(value, bool)
                and rule["low"] <= value <= rule["high"])
        wanted = (f"a whole number from {rule['low']:g} to {rule['high']:g}" if kind == "int" else
                  f"a number from {rule['low']:g} to {rule['high']:g}")
    else:
        fits = type(value).__name__ == kind
        wanted = {"bool": "true or false", "str": "a text"}[kind]
    if not fits:
        raise SettingsError(
            f"{where}: '{entry.name}' must be {wanted}, not {reprlib.repr(value)[:80]}")
    return float(value) if kind == "float" else value


def _type_name(entry: Field) -> str:
    """float, int, bool or str; annotations may be strings, because they are not evaluated."""
    return entry.type if isinstance(entry.type, str) else entry.type.__name__


def _table(path: Path, section: str | None, place: str) -> dict:
    values = read_yaml(path, SettingsError)
    if section is not None:
        values = values.get(section) if isinstance(values, dict) else None
    if not isinstance(values, dict):
        raise SettingsError(f"{place}: not a table of 'key: value' lines")
    return values
