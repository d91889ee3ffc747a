"""A chain of filters from the list that upstream's YAML files hold."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any, get_type_hints

import numpy as np

from laser_filters.filters import FILTERS
from laser_filters.scan import Observations, PointsIn, Scan, ScanFilter

OVER_SCANS = {f"MultiChannel{kind}Filter{number}": kind.lower()
              for kind in ("Median", "Mean") for number in ("Float", "Double")}


class BadChain(ValueError):
    """A chain that cannot be used; the text names the entry and what is allowed there."""


class Chain:
    """The filters in their order, and `ignored`, a line for each parameter without effect."""

    def __init__(self, entries: Any, name: str) -> None:
        """`entries`: the list in parameter `name`; raises BadChain."""
        self.ignored: list[str] = []
        if not isinstance(entries, list):
            raise BadChain(f"{name} has to be a list of entries with name, type and params")
        self._filters = [self._read(entry, f"{name}[{number}]")
                         for number, entry in enumerate(entries)]

    def filtered(self, scan: Scan, points_in: PointsIn) -> Scan:
        """The scan after all filters; whatever `points_in` raises is passed on."""
        with np.errstate(invalid="ignore", over="ignore"):  # nan and inf are ranges, too
            for one in self._filters:
                before = scan
                scan = one.filtered(scan, lambda frame, before=before: points_in(frame, before))
        return scan

    def _read(self, entry: Any, where: str) -> ScanFilter:
        kind, params, where = _parts(entry, where, FILTERS)
        allowed = {field.name: field for field in dataclasses.fields(FILTERS[kind])}
        for name in params.keys() - allowed.keys():
            self.ignored.append(f"{where}: {kind} knows no parameter {name}"
                                + _near(name, allowed))
        missing = [name for name, field in allowed.items() if name not in params
                   and dataclasses.MISSING is field.default is field.default_factory]
        if missing:
            raise BadChain(f"{where}: {kind} needs {', '.join(missing)}")
        types = get_type_hints(FILTERS[kind])
        values = {name: _value(params[name], types[name], f"{where}: {name}")
                  for name in allowed if name in params}
        for name, value in values.items():
            choices = allowed[name].metadata.get("choices")
            if choices and value not in choices:
                raise BadChain(f"{where}: {name} is {value}; here it can only be "
                               f"{' or '.join(map(str, choices))}")
        try:
            return FILTERS[kind](**values)
        except ValueError as error:
            raise BadChain(f"{where}: {error}") from None


def _parts(entry: Any, where: str, kinds: Iterable[str]) -> tuple[str, dict, str]:
    """(type without its package, params, where with the entry's name); raises BadChain."""
    if not isinstance(entry, Mapping) or "type" not in entry:
        raise BadChain(f"{where} has to be an entry with name, type and params")
    where = f"{where} ({entry['name']})" if "name" in entry else where
    kind, params = str(entry["type"]).rpartition("/")[2], entry.get("params") or {}
    if kind not in kinds:
        raise BadChain(f"{where}: there is no filter {entry['type']}{_near(kind, kinds)}; "
                       f"there are {', '.join(sorted(kinds))}")
    if not isinstance(params, Mapping):
        raise BadChain(f"{where}: params have to be names with values")
    return kind, dict(params), where


def _near(name: str, known: Iterable[str]) -> str:
    near = get_close_matches(name, list(known), 1, 0.6)
    return f" (did you mean {near[0]}?)" if near else ""


def _value(value: Any, kind: Any, where: str) -> Any:
    if kind is Observations:
        return _observations(value, where)
    if kind is float and isinstance(value, str):  # .nan and .inf lose their type on the way
        try:
            value = float(value)
        except ValueError:
            pass
    if kind is float and type(value) is int:
        value = float(value)
    if type(value) is not kind:
        raise BadChain(f"{where} is {value!r}; it has to be of type {kind.__name__}")
    return value


def _observations(entries: Any, where: str) -> Observations:
    stages = []
    for number, entry in enumerate(entries if isinstance(entries, list) else [entries]):
        kind, params, named = _parts(entry, f"{where}[{number}]", OVER_SCANS)
        count = params.get("number_of_observations")
        if type(count) is not int or count < 1:
            raise BadChain(f"{named}: number_of_observations is {count!r}; it has to be a whole "
                           "number above 0")
        stages.append((OVER_SCANS[kind], count))
    return Observations(tuple(stages))
