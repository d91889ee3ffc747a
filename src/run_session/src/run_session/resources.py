"""Files of packages, and YAML files that hold the fields of a dataclass."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import rospkg
import yaml

from run_session.failure import RunError


def find_package(name: str) -> Path:
    """The folder of a package."""
    try:
        return Path(rospkg.RosPack().get_path(name))
    except rospkg.ResourceNotFound as error:
        raise RunError(f"package {name} not found: source devel/setup.bash") from error


def located(text: str) -> Path:
    """The path for a plain path or package://PACKAGE/PATH."""
    package, _, rest = text.removeprefix("package://").partition("/")
    return find_package(package) / rest if text.startswith("package://") else Path(text)


def load_record(kind: type, name: str, folder: Path) -> Any:
    """An instance of dataclass `kind` from NAME.yaml of a folder, or from the file of that path.

    Fields have one of the types in RULES. A RunError names file and key.
    """
    path = Path(name) if name.endswith(".yaml") else folder / f"{name}.yaml"
    if not name.endswith(".yaml") and not path.exists():
        known = ", ".join(sorted(found.stem for found in folder.glob("*.yaml")))
        what = folder.name[:-1]
        raise RunError(f"no {what} {name!r} (--{what}); there are: {known}")
    values = read_keys(path, [field.name for field in fields(kind)])
    for field in fields(kind):
        wanted, fits = RULES[field.type]
        if not fits(values[field.name]):
            raise RunError(f"{path}: {field.name}: must be {wanted}, is "
                           f"{reprlib.repr(values[field.name])[:80]}")
    return kind(**{key: _frozen(value) for key, value in values.items()})


def _frozen(value: object) -> object:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def _is_number(value: object, least: float = -math.inf) -> bool:
    return type(value) in (int, float) and least <= value < math.inf


def _are(value: object, fits: Callable[[object], bool], count: int | None = None) -> bool:
    """Whether it is a list of `count` (None: any number of) values that fit."""
    return isinstance(value, list) and count in (None, len(value)) and all(map(fits, value))


def _is_text(value: object) -> bool:
    return isinstance(value, str)


Length = float  # positive: 0 makes no sense
RULES: dict[str, tuple[str, Callable[[object], bool]]] = {
    "str": ("a text", _is_text),
    "float": ("a number, 0 or more", lambda value: _is_number(value, 0.0)),
    "Length": ("a number above 0", lambda value: _is_number(value, 0.0) and value > 0),
    "tuple[str, str]": ("[package, file]", lambda value: _are(value, _is_text, 2)),
    "tuple[str, ...]": ("a list of topics", lambda value: _are(value, _is_text)),
    "tuple[float, float, float]": ("[x, y, yaw]", lambda value: _are(value, _is_number, 3)),
    "tuple[tuple[float, float], ...]": ("a list of [x, y]", lambda value: bool(value) and _are(
        value, lambda point: _are(point, _is_number, 2))),
}


def read_keys(path: Path, expected: Sequence[str]) -> dict:
    """The content of a YAML file that has exactly these keys; a RunError names file and key."""
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise RunError(f"{path}: not a text file") from error
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise RunError(f"{path}: not valid YAML: {' '.join(str(error).split())[:200]}") from error
    if not isinstance(values, dict) or set(values) != set(expected):
        given = set(values) if isinstance(values, dict) else set()
        wrong = sorted(given - set(expected), key=str) or sorted(set(expected) - given)
        kind = "unknown" if given - set(expected) else "missing"
        raise RunError(f"{path}: {kind} key {wrong[0]!r:.80}; there are: {', '.join(expected)}")
    return values
