"""The detector's numbers: from its YAML file, and from the node's own parameters, which win."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import yaml

# Of a file that is not there or no YAML; a date of month 13 is a ValueError, `!!timestamp x` an
# AttributeError.
NOT_READ = (OSError, ValueError, AttributeError, RecursionError, yaml.YAMLError)


class SettingsError(Exception):
    """A file or parameter says something that cannot be; one line that names it."""


@dataclass(frozen=True)
class Settings:
    """See config/detector_params.yaml."""

    confidence: float  # 0..1
    iou: float  # 0..1
    max_rate: float  # pictures a second, wall time; 0: as many as come
    threads: int


LIMITS = {"confidence": (0.0, 1.0), "iou": (0.0, 1.0), "max_rate": (0.0, 1000.0),
          "threads": (1, 64)}


def read_settings(path: Path | str, given: dict[str, object]) -> Settings:
    """The file's numbers with those of `given` (ROS parameters) in their place."""
    try:
        table = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except NOT_READ as error:
        reason = (str(error).splitlines() or [type(error).__name__])[0]
        raise SettingsError(f"{path}: cannot be read: {reason}") from None
    if not isinstance(table, dict):
        raise SettingsError(f"{path}: not a table of 'key: number' lines")
    known = [field.name for field in fields(Settings)]
    for key in table:
        if key not in known:
            raise SettingsError(f"{path}: unknown key '{key}'; known: {', '.join(known)}")
    for key in known:
        if key not in table and key not in given:
            raise SettingsError(f"{path}: missing key '{key}'")
    checked = {key: _checked(table[key], key, f"{path}: {key}") for key in table}
    checked |= {key: _checked(value, key, f"~{key}") for key, value in given.items()}
    return Settings(**checked)


def _checked(value: object, key: str, where: str) -> float:
    lowest, highest = LIMITS[key]
    whole = isinstance(lowest, int)
    kinds = (int,) if whole else (int, float)
    if isinstance(value, bool) or not isinstance(value, kinds) or not lowest <= value <= highest:
        what = "a whole number" if whole else "a number"
        raise SettingsError(f"{where} must be {what} from {lowest:g} to {highest:g}, not {value!r}")
    return value if whole else float(value)
