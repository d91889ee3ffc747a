"""A node's settings: a dataclass filled from a YAML file, overridden by ROS parameters.

The YAML file has all defaults; the dataclass has types, bounds and meanings.
"""

from __future__ import annotations

import reprlib
from collections.abc import Mapping
from dataclasses import Field, field, fields
from pathlib import Path
from typing import Any, TypeVar

import yaml

Settings = TypeVar("Settings")


class SettingsError(ValueError):
    """One line that names the file (or parameters), the key, and the error."""


def bounded(low: float, high: float, meaning: str) -> Any:
    """A dataclass field of type float within these bounds; the meaning has its unit."""
    return field(metadata={"low": float(low), "high": float(high), "meaning": meaning})


def explained(meaning: str) -> Any:
    """A dataclass field of type bool or str."""
    return field(metadata={"meaning": meaning})


def load_settings(
    kind: type[Settings],
    path: str | Path,
    section: str | None = None,
    given: Mapping[str, object] | None = None,
) -> Settings:
    """An instance of the dataclass `kind` (fields of float, bool, str) from a file's table.

    section: the table's key in the file, None for the whole file. Keys in `given`, the node's own
    ROS parameters, take precedence. Any error is a SettingsError.
    """
    place = f"{path}: {section}" if section else str(path)
    values = _read_table(Path(path), section, place)
    known = {entry.name: entry for entry in fields(kind)}
    result: dict[str, object] = {}
    for where, table in ((place, values), ("the node's parameters", given or {})):
        for key, value in table.items():
            if key not in known:
                raise SettingsError(f"{where}: unknown key {key!r:.80}; known: {', '.join(known)}")
            result[key] = checked(known[key], value, where)
    for key in known:
        if key not in values:
            raise SettingsError(f"{place}: missing key '{key}'")
    try:
        return kind(**result)
    except ValueError as error:  # the dataclass's own check of its values' combination
        raise SettingsError(f"{place} and the node's parameters: {error}") from error


def checked(entry: Field, value: object, where: str) -> object:
    """The value as this field's type; SettingsError if it is invalid."""
    kind, given = _type_name(entry), reprlib.repr(value)[:80]
    if kind != "float":
        if type(value).__name__ != kind:
            wanted = {"bool": "true or false", "str": "a text"}[kind]
            raise SettingsError(f"{where}: '{entry.name}' must be {wanted}, not {given}")
        return value
    low, high = entry.metadata["low"], entry.metadata["high"]
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not (number and low <= value <= high):
        raise SettingsError(
            f"{where}: '{entry.name}' must be a number from {low:g} to {high:g}, not {given}"
        )
    return float(value)


def _type_name(entry: Field) -> str:
    """float, bool or str; annotations are strings here, because they are not evaluated."""
    return entry.type if isinstance(entry.type, str) else entry.type.__name__


def _read_table(path: Path, section: str | None, place: str) -> dict:
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SettingsError(f"{path}: {error.strerror}") from error
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise SettingsError(f"{path}: not valid YAML: {' '.join(str(error).split())[:200]}") \
            from error
    if section is not None:
        values = values.get(section) if isinstance(values, dict) else None
    if not isinstance(values, dict):
        raise SettingsError(f"{place}: not a table of 'key: value' lines")
    return values
