"""Numbers from config/tracking_params.yaml, checked: a mistake names file and key."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import Field, field, fields
from pathlib import Path
from typing import Any, TypeVar

import yaml

Settings = TypeVar("Settings")


class SettingsError(Exception):
    """One line: which file, which key, what is wrong."""


def number(low: float, high: float, meaning: str) -> Any:
    """A field of type float from `low` to `high`; the meaning says its unit."""
    return field(metadata={"low": low, "high": high, "meaning": meaning})


def load_settings(
    kind: type[Settings], path: Path, section: str, given: Mapping[str, object]
) -> Settings:
    """The dataclass `kind` from the file's section; keys in `given` (ROS parameters) win.

    Raises SettingsError for an unknown or missing key and for a value that does not fit.
    """
    values = _section(path, section)
    known = {entry.name: entry for entry in fields(kind)}
    for where, table in ((f"{path}: {section}", values), ("the node's parameters", given)):
        for key in table:
            if key not in known:
                raise SettingsError(f"{where}: unknown key '{key}'; known: {', '.join(known)}")
    for key in known:
        if key not in values:
            raise SettingsError(f"{path}: {section}: missing key '{key}'")
    merged = {key: (f"{path}: {section}", value) for key, value in values.items()}
    merged |= {key: ("the node's parameters", value) for key, value in given.items()}
    return kind(**{key: checked(known[key], value, where)
                   for key, (where, value) in merged.items()})


def checked(entry: Field, value: object, where: str) -> float:
    """The value as a number within the field's bounds; SettingsError if it is none."""
    low, high = entry.metadata["low"], entry.metadata["high"]
    fits = isinstance(value, int | float) and not isinstance(value, bool)
    if not (fits and low <= value <= high):
        raise SettingsError(
            f"{where}: '{entry.name}' must be a number from {low:g} to {high:g}, not {value!r}")
    return float(value)


def _section(path: Path, section: str) -> dict:
    try:
        sections = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SettingsError(f"{path}: {error.strerror}") from error
    except (ValueError, AttributeError, RecursionError, yaml.YAMLError) as error:
        # A date of month 13 is a ValueError, `!!timestamp x` an AttributeError.
        raise SettingsError(f"{path}: no YAML: {' '.join(str(error).split())}") from error
    values = sections.get(section) if isinstance(sections, dict) else None
    if not isinstance(values, dict):
        raise SettingsError(f"{path}: no section '{section}:' with lines of 'key: number' in it")
    return values
