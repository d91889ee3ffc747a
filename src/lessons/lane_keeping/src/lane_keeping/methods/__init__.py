"""One module per lane detection method; each has `plan(mask, view, settings) -> Plan | None`.

mask: (rows, columns) uint8 of the region of interest, 255 where a line may be. None: no lane.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from lane_keeping.settings import METHODS


def method_called(name: str) -> Callable:
    """The `plan` of this method; ValueError lists the known ones."""
    if name not in METHODS:
        raise ValueError(f"no method '{name}'; known: {', '.join(METHODS)}")
    return import_module(f"lane_keeping.methods.{name}").plan
