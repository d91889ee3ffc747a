"""Dataclasses from YAML files that hold exactly their fields; an error names file and key.

`fault`, an exception, is what a reader's caller expects: it is raised with one line.
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Annotated, Any, TypeVar, get_args, get_origin, get_type_hints

import yaml

T = TypeVar("T")
Fault = Callable[[str], Exception]


@dataclass(frozen=True)
class Must:
    """What a field's value has to be, in words, and whether it is: for `Annotated`."""

    be: str
    fits: Callable[[Any], bool]


def is_number(value: object, least: float = 0.0, most: float = math.inf) -> bool:
    """Whether it is a finite number within these bounds."""
    return type(value) in (int, float) and least <= value <= most and abs(value) < math.inf


def are(value: object, fits: Callable[[Any], bool], count: int | None = None) -> bool:
    """Whether it is a list of `count` (None: any number of) values that fit."""
    return isinstance(value, list) and count in (None, len(value)) and all(map(fits, value))


def is_text(value: object) -> bool:
    """Whether it is a text."""
    return isinstance(value, str)


def is_whole(value: object) -> bool:
    """Whether it is a whole number, 0 or more."""
    return type(value) is int and 0 <= value < 10**8


# 0 makes no sense for a Length.
Length = Annotated[float, Must("a number above 0", lambda value: is_number(value) and value > 0)]
Anywhere = Annotated[float, Must("a number", lambda value: is_number(value, -math.inf))]
MUST = {
    str: Must("a text", is_text),
    bool: Must("true or false", lambda value: isinstance(value, bool)),
    int: Must("a whole number, 0 or more", is_whole),
    float: Must("a number, 0 or more", is_number),
    tuple[str, ...]: Must("a list of texts", lambda value: are(value, is_text)),
    tuple[int, ...]: Must("a list of whole numbers", lambda value: are(value, is_whole)),
    tuple[float, ...]: Must("a list of numbers", lambda value: are(value, is_number)),
}


def read_yaml(path: Path, fault: Fault, loader: type[yaml.SafeLoader] = yaml.SafeLoader) -> Any:
    """The content of a YAML file; `fault` says why there is none."""
    try:
        return yaml.load(path.read_text(encoding="utf-8"), loader)
    except OSError as error:
        raise fault(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise fault(f"{path}: not a text file") from error
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise fault(f"{path}: not valid YAML: {yaml_fault(error)}") from error


def yaml_fault(error: Exception) -> str:
    """PyYAML's error in one line: where, and what is wrong there."""
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark:
        mark = error.problem_mark
        return f"line {mark.line + 1}, column {mark.column + 1}: {error.problem}"
    return " ".join(str(error).split())[:200]


def check_keys(place: object, values: object, expected: Iterable[str], fault: Fault,
               within: str = "") -> None:
    """`fault` unless `values` has exactly the keys; `within` stands before a key in the message."""
    given = set(values) if isinstance(values, dict) else set()
    for what, keys in (("unknown", given - set(expected)), ("missing", set(expected) - given)):
        if keys:
            key = min(keys, key=str)
            raise fault(f"{place}: {what} key {f'{within}{key}' if within else key!r:.80}; there "
                        f"are: {', '.join(expected)}")


def to_record(kind: type[T], values: object, place: object, fault: Fault, within: str = "") -> T:
    """An instance of the dataclass `kind`; `place`: the file.

    Fields may be dataclasses, or tuples of any number of one.
    """
    check_keys(place, values, [field.name for field in fields(kind)], fault, within)
    return kind(**{name: _value(wanted, values[name], place, fault, f"{within}{name}")
                   for name, wanted in get_type_hints(kind, include_extras=True).items()})


def _value(wanted: Any, value: object, place: object, fault: Fault, key: str) -> Any:
    """The value as the type `wanted` of a field."""
    if is_dataclass(wanted):
        return to_record(wanted, value, place, fault, f"{key}.")
    if get_origin(wanted) is tuple and is_dataclass(part := get_args(wanted)[0]):
        if not isinstance(value, list):
            keys = ", ".join(field.name for field in fields(part))
            raise fault(f"{place}: {key}: must be a list of {{{keys}}}")
        return tuple(to_record(part, each, place, fault, f"{key}[{number}].")
                     for number, each in enumerate(value))
    kind, must = (get_args(wanted)[0], get_args(wanted)[-1]) \
        if get_origin(wanted) is Annotated else (wanted, MUST[wanted])
    if not must.fits(value):
        raise fault(f"{place}: {key}: must be {must.be}, is {reprlib.repr(value)[:80]}")
    return float(value) if kind is float else _frozen(value)


def _frozen(value: object) -> object:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def load_record(kind: type[T], name: str, folder: Path, fault: Fault) -> T:
    """An instance of dataclass `kind` from NAME.yaml of a folder, or from the file of that path."""
    path = Path(name) if name.endswith(".yaml") else folder / f"{name}.yaml"
    if not name.endswith(".yaml") and not path.exists():
        known = ", ".join(sorted(found.stem for found in folder.glob("*.yaml")))
        what = folder.name[:-1]
        raise fault(f"no {what} {name!r} (--{what}); there are: {known}")
    return to_record(kind, read_yaml(path, fault), path, fault)
