"""A display's options by rviz's names, with their allowed values. Without ROS."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

LONGEST_TEXT = 1000
FIXED_FRAME = "<Fixed Frame>"


@dataclass(frozen=True)
class Option:
    """One option; numbers lie between `low` and `high`, colours are rviz's `255; 0; 0`.

    `kind`: color, number, integer, switch, choice, text, frame or namespaces.
    """

    name: str
    kind: str
    default: Any
    choices: tuple[str, ...] = ()
    low: float = 0.0
    high: float = 1e6

    def check(self, value: Any) -> Any:
        """The checked value; ValueError says why it is not allowed."""
        read = getattr(self, f"_{self.kind}")(value)
        if read is None:
            raise ValueError(f"{self.name} is {value!r:.40}, which is not {self._expected()}")
        return read

    def as_json(self) -> dict[str, Any]:
        """The option's data for the page."""
        return asdict(self)

    def _expected(self) -> str:
        if self.kind == "choice":
            return f"one of {', '.join(self.choices)}"
        span = f"from {self.low:g} to {self.high:g}"
        return {"color": "a colour such as 255; 0; 0", "switch": "true or false",
                "namespaces": "a mapping to true or false", "integer": f"an integer {span}",
                "number": f"a number {span}"}.get(self.kind, f"a {self.kind}")

    def _number(self, value: Any) -> float | None:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return None
        return value if self.low <= value <= self.high else None  # NaN is not

    def _integer(self, value: Any) -> int | None:
        return value if isinstance(value, int) and self._number(value) is not None else None

    def _switch(self, value: Any) -> bool | None:
        return value if isinstance(value, bool) else None

    def _choice(self, value: Any) -> str | None:
        return value if value in self.choices else None

    def _text(self, value: Any) -> str | None:
        return value if isinstance(value, str) and len(value) <= LONGEST_TEXT else None

    _frame = _text

    def _color(self, value: Any) -> str | None:
        return value if isinstance(value, str) and rgb(value) else None

    def _namespaces(self, value: Any) -> dict[str, bool] | None:
        fits = isinstance(value, Mapping) and all(
            isinstance(name, str) and isinstance(shown, bool) for name, shown in value.items())
        return dict(value) if fits else None


def rgb(text: str) -> tuple[int, int, int] | None:
    """Red, green and blue, 0 to 255, of rviz's `255; 0; 0`; None if it is not a colour."""
    try:
        red, green, blue = (int(part) for part in text.split(";"))
    except ValueError:
        return None
    return (red, green, blue) if all(0 <= part <= 255 for part in (red, green, blue)) else None


def defaults(options: tuple[Option, ...]) -> dict[str, Any]:
    """Each option's default by its name."""
    return {option.name: option.default for option in options}


def check_all(options: tuple[Option, ...], given: Mapping[str, Any]) -> dict[str, Any]:
    """The defaults with the `given` values; ValueError for unknown options and invalid values."""
    known = {option.name: option for option in options}
    if unknown := sorted(set(given) - set(known)):
        raise ValueError(f"there is no option {unknown[0]!r:.40}; "
                         f"there are {', '.join(known) or 'none'}")
    return defaults(options) | {name: known[name].check(value) for name, value in given.items()}
