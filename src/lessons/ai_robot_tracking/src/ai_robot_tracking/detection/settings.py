"""The detector's settings: from its YAML file, overridden by the node's own parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path

import yaml

from ai_robot_tracking.settings import (
    SettingsError,
    checked,
    count,
    number,
    refuse_missing,
    refuse_unknown,
)


@dataclass(frozen=True)
class Settings:
    """See config/detector_params.yaml."""

    confidence: float = number(0, 1, "detections with lower scores are dropped")
    iou: float = number(0, 1, "of boxes that overlap more, the best score stays")
    max_rate: float = number(0, 1000, "images per second of wall time; 0: no limit")
    threads: int = count(1, 64, "for inference")


FIELDS = {entry.name: entry for entry in fields(Settings)}


def read_settings(path: Path | str, given: Mapping[str, object]) -> Settings:
    """The file's settings, overridden by those in `given` (ROS parameters).

    Raises SettingsError for an unknown or missing key, or an invalid value.
    """
    table = read_yaml(Path(path))
    if not isinstance(table, dict):
        raise SettingsError(f"{path}: not a table of 'key: number' lines")
    refuse_unknown(table, FIELDS, path)
    refuse_missing(FIELDS, {**table, **given}, path)
    values = {key: checked(FIELDS[key], value, f"{path}: {key}") for key, value in table.items()}
    values |= {key: checked(FIELDS[key], value, f"~{key}") for key, value in given.items()}
    return Settings(**values)


def read_yaml(path: Path) -> object:
    """The file's contents; SettingsError if it does not exist or is not YAML."""
    try:
        return yaml.safe_load(path.read_text(encoding="utf-8"))
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        reason = (str(error).splitlines() or [type(error).__name__])[0]
        raise SettingsError(f"{path}: cannot be read: {reason}") from None
