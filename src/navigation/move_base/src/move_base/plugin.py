"""Base class of planners and recoveries, which are chosen by name: parameters and their changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import Any

import rospkg

from nav_nodes.parameters import (
    Parameter,
    ParameterError,
    load_table,
    read_parameters,
    serve_changes,
)

PARAMS = Path(rospkg.RosPack().get_path("move_base")) / "params"


@cache
def table(name: str) -> list[Parameter]:
    """The table in params/NAME.yaml."""
    return load_table(PARAMS / f"{name}.yaml")


def settings_from(kind: type, values: Mapping[str, Any], **others: Any) -> Any:
    """A settings dataclass from those values that are its fields; `others` override them."""
    names = {field.name for field in fields(kind)}
    return kind(**{**{name: values[name] for name in names & values.keys()}, **others})


def chosen(name: str, known: Mapping[str, Any], where: str) -> Any:
    """The entry of that name; upstream's older names without the package are accepted, too.

    Raises ParameterError that lists the known names.
    """
    found = {**{full.rpartition("/")[2]: kind for full, kind in known.items()}, **known}.get(name)
    if found is None:
        raise ParameterError(f"{where} is {name!r}, but there are only {', '.join(sorted(known))}")
    return found


class Plugin:
    """Parameters from `~NAME/`, offered there by dynamic_reconfigure if they may change.

    Subclasses set NAME and TABLE, and take new values in `change`.
    """

    NAME = ""
    TABLE = ""

    def __init__(self) -> None:
        """Raises ParameterError for an invalid value."""
        self.values = read_parameters(self.entries, f"~{self.NAME}/")
        self.change(self.values)
        self._server = (serve_changes(self.entries, self.values, self.change, self.NAME)
                        if any(entry.change for entry in self.entries) else None)

    @property
    def entries(self) -> list[Parameter]:
        """The entries of its table."""
        return table(self.TABLE)

    def change(self, values: dict[str, Any]) -> None:
        """Takes all values, at the start and after each change; may raise ParameterError."""
        self.values = values

    def close(self) -> None:
        """Ends it: another takes its place."""
        if self._server is not None:
            self._server.set_service.shutdown()
            self._server.descr_topic.unregister()
            self._server.update_topic.unregister()
