"""Numbers from YAML files, checked against a dataclass; errors name file and key."""

from __future__ import annotations

import reprlib
from collections.abc import Collection, Iterable, Mapping
from dataclasses import Field, field, fields
from pathlib import Path
from typing import Any, TypeVar

import yaml

Settings = TypeVar("Settings")


class SettingsError(ValueError):
    """One line with the file, the key, and the error."""


def number(low: float, high: float, meaning: str) -> Any:
    """A field of type float from `low` to `high`; the meaning has its unit."""
    return field(metadata={"low": low, "high": high, "meaning": meaning, "whole": False})


def count(low: int, high: int, meaning: str) -> Any:
    """A field of type int from `low` to `high`."""
    return field(metadata={"low": low, "high": high, "meaning": meaning, "whole": True})


def load_settings(
    kind: type[Settings], path: Path, section: str, given: Mapping[str, object]
) -> Settings:
    """The dataclass `kind` from the file's section; keys in `given` (ROS parameters) override it.

    Raises SettingsError for an unknown or missing key, or an invalid value.
    """
    values = _section(path, section)
    known = {entry.name: entry for entry in fields(kind)}
    in_file, in_node = f"{path}: {section}", "the node's parameters"
    refuse_unknown(values, known, in_file)
    refuse_unknown(given, known, in_node)
    refuse_missing(known, values, in_file)
    merged = {key: (in_file, value) for key, value in values.items()}
    merged |= {key: (in_node, value) for key, value in given.items()}
    return kind(**{key: checked(known[key], value, f"{where}: '{key}'")
                   for key, (where, value) in merged.items()})


def refuse_unknown(keys: Iterable[object], known: Collection[str], where: str | Path) -> None:
    """SettingsError for the first unknown key."""
    for key in keys:
        if key not in known:
            raise SettingsError(f"{where}: unknown key {key!r:.80}; known: {', '.join(known)}")


def refuse_missing(known: Iterable[str], keys: Collection[object], where: str | Path) -> None:
    """SettingsError for the first missing key."""
    for key in known:
        if key not in keys:
            raise SettingsError(f"{where}: missing key '{key}'")


def checked(entry: Field, value: object, what: str) -> float:
    """The value, if it is within its field's bounds: a float, or an int if the field is a count.

    Else SettingsError; `what` names file and key in it.
    """
    low, high, whole = (entry.metadata[key] for key in ("low", "high", "whole"))
    fits = isinstance(value, int if whole else int | float) and not isinstance(value, bool)
    if not (fits and low <= value <= high):
        wanted = "a whole number" if whole else "a number"
        raise SettingsError(f"{what} must be {wanted} from {low:g} to {high:g}, not "
                            f"{reprlib.repr(value)[:80]}")
    return value if whole else float(value)


def _section(path: Path, section: str) -> dict:
    try:
        sections = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SettingsError(f"{path}: {error.strerror}") from error
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise SettingsError(f"{path}: not valid YAML: {' '.join(str(error).split())[:200]}") \
            from error
    values = sections.get(section) if isinstance(sections, dict) else None
    if not isinstance(values, dict):
        raise SettingsError(f"{path}: no section '{section}:' with lines of 'key: number' in it")
    return values
