"""Reads the parameters of a controller or of joints, with errors that name the parameter."""

from __future__ import annotations

import math
from typing import Any

from bullet_sim.errors import PluginError

REQUIRED = object()  # stands for: there is no default


class ControllerParameters:
    """All parameters below a namespace. Names may be paths such as `pid/p`.

    A parameter of the wrong type, or not set and without a default, is a PluginError.
    """

    def __init__(self, namespace: str, values: Any, remedy: str = ""):
        """`values`: a tree of dictionaries, as YAML has it; anything else stands for none.

        `remedy` ends the error of a parameter that is not set; `{above}` in it is the namespace
        around this one.
        """
        self.namespace = namespace
        self._values = values if isinstance(values, dict) else {}
        self._remedy = remedy

    def group(self, name: str) -> ControllerParameters:
        """The parameters below a name; none if it is not set."""
        return ControllerParameters(self.where(name), self._find(name), self._remedy)

    def groups(self) -> dict[str, ControllerParameters]:
        """All groups by name, such as the controllers of a file, in its order."""
        return {name: self.group(name) for name, value in self._values.items()
                if isinstance(value, dict)}

    def has(self, name: str) -> bool:
        """Whether a parameter or a group of this name is set."""
        return self._find(name) is not None

    def value(self, name: str, default: Any = REQUIRED) -> Any:
        """The value as on the server; PluginError if it is not set and has no default."""
        found = self._find(name)
        if found is not None:
            return found
        if default is REQUIRED:
            remedy = self._remedy.format(above=self.namespace.rpartition("/")[0] or "/")
            raise PluginError(f"parameter {self.where(name)} is not set{remedy}")
        return default

    def text(self, name: str, default: Any = REQUIRED) -> str:
        """A text; else a PluginError."""
        return self._checked(name, default, lambda v: isinstance(v, str) and v, "a name")

    def flag(self, name: str, default: Any = REQUIRED) -> bool:
        """true or false; else a PluginError."""
        return self._checked(name, default, lambda v: isinstance(v, bool), "true or false")

    def number(self, name: str, default: Any = REQUIRED) -> float:
        """A finite number; else a PluginError."""
        return float(self._checked(name, default, _is_number, "a number"))

    def texts(self, name: str, default: Any = REQUIRED) -> list[str]:
        """A list of at least one name, or a single name; else a PluginError."""
        def good(value) -> bool:
            return bool(value) and all(isinstance(item, str) and item for item in value)

        found = self.value(name, default)
        if isinstance(found, str) and found:
            return [found]
        return list(self._checked(name, default, lambda v: isinstance(v, list | tuple) and good(v),
                                  "a list of names"))

    def pair(self, name: str, what: str) -> list[str]:
        """Two names; else a PluginError, `what` says which two."""
        found = self.texts(name)
        if len(found) != 2:
            raise PluginError(f"parameter {self.where(name)} has {len(found)} joints; {what}")
        return found

    def numbers(self, name: str, count: int, default: Any = REQUIRED) -> list[float]:
        """A list of `count` finite numbers; else a PluginError."""
        def good(value) -> bool:
            return isinstance(value, list | tuple) and len(value) == count and all(
                map(_is_number, value))

        found = self._checked(name, default, good, f"a list of {count} numbers")
        return [float(item) for item in found]

    def where(self, name: str) -> str:
        """The parameter's full name."""
        return f"{self.namespace.rstrip('/')}/{name}"

    def _checked(self, name: str, default: Any, good, what: str) -> Any:
        found = self.value(name, default)
        if found is not default and not good(found):
            raise PluginError(f"parameter {self.where(name)} is {found!r}, which is not {what}")
        return found

    def _find(self, name: str) -> Any:
        found = self._values
        for part in name.split("/"):
            if not isinstance(found, dict) or part not in found:
                return None
            found = found[part]
        return found


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
