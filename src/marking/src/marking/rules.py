"""The teacher's marking.yaml, checked: a wrong key or value is one line that names file and key."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, get_type_hints

import yaml

from evaluation.session.failure import RunError


@dataclass(frozen=True)
class Points:
    """What a case is worth."""

    finish: float
    line: float
    line_best_m: float
    line_worst_m: float
    speed: float
    speed_best_m_s: float
    speed_worst_m_s: float

    @property
    def most(self) -> float:
        return self.finish + self.line + self.speed


@dataclass(frozen=True)
class Limits:
    """What a submission may use in one case."""

    start_s: float
    simulated_s: float
    wall_s: float
    answer_s: float
    unanswered: float
    cpu_s: float
    memory_mb: float
    processes: float
    disk_mb: float
    output_mb: float


@dataclass(frozen=True)
class Rules:
    """A marking.yaml, key by key."""

    course: str
    program: tuple[str, ...]
    laps: int
    tracks: tuple[str, ...]
    seeds: int
    first_seed: int
    start_sideways_m: float
    start_turn_deg: float
    light: tuple[float, ...]
    points: Points
    limits: Limits
    may_publish: tuple[str, ...]
    may_call: tuple[str, ...]


def load_rules(path: Path) -> Rules:
    """Read a marking.yaml; RunError names file and key."""
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}") from error
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        raise RunError(f"{path}: no YAML: {' '.join(str(error).split())}") from error
    rules = _read(Rules, values, str(path), "")
    if len(rules.light) != 2 or not 0 < rules.light[0] <= rules.light[1]:
        raise RunError(f"{path}: light: must be [least, most], more than 0")
    if not rules.program:
        raise RunError(f"{path}: program: must name a file")
    if rules.laps < 1 or rules.seeds < 1:
        raise RunError(f"{path}: {'laps' if rules.laps < 1 else 'seeds'}: must be 1 or more")
    if not rules.points.most:
        raise RunError(f"{path}: points: finish, line and speed are all 0")
    small = [key for key, value in dataclasses.asdict(rules.limits).items() if value <= 0]
    if small:
        raise RunError(f"{path}: limits.{small[0]}: must be more than 0")
    tracks = tuple(str((path.parent / track).resolve()) for track in rules.tracks)
    return dataclasses.replace(rules, tracks=tracks)


def _read(kind: type, values: Any, path: str, prefix: str) -> Any:
    names = [field.name for field in fields(kind)]
    if not isinstance(values, dict):
        raise RunError(f"{path}: {prefix.rstrip('.') or 'it'} must hold {', '.join(names)}")
    for key in values:
        if key not in names:
            raise RunError(f"{path}: unknown key '{prefix}{key}'; there are: {', '.join(names)}")
    for key in names:
        if key not in values:
            raise RunError(f"{path}: missing key '{prefix}{key}'")
    hints = get_type_hints(kind)
    return kind(**{key: _value(hints[key], values[key], path, prefix + key) for key in names})


def _value(kind: Any, value: Any, path: str, key: str) -> Any:
    if dataclasses.is_dataclass(kind):
        return _read(kind, value, path, f"{key}.")
    if kind is str and isinstance(value, str):
        return value
    if kind is int and type(value) is int and 0 <= value < 10**8:
        return value
    if kind is float and _is_number(value):
        return float(value)
    if kind == tuple[str, ...] and isinstance(value, list) and all(
            isinstance(each, str) for each in value):
        return tuple(value)
    if kind == tuple[float, ...] and isinstance(value, list) and all(map(_is_number, value)):
        return tuple(map(float, value))
    raise RunError(f"{path}: {key}: must be {_WANTED[kind]}, is {value!r}")


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and 0 <= value < math.inf


_WANTED = {str: "a text", int: "a whole number, 0 or more", float: "a number, 0 or more",
           tuple[str, ...]: "a list of texts", tuple[float, ...]: "a list of numbers"}
