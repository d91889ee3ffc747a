"""A display's options by rviz's names, their allowed values, and colours. Without ROS."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

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


def rgba(options: dict[str, Any], color: str = "Color", alpha: str = "Alpha") -> tuple:
    """Red, green, blue, alpha, 0 to 255, from two options; without an alpha option opaque."""
    return (*rgb(options[color]), round(255 * options.get(alpha, 1.0)))


def rainbow(values: np.ndarray) -> np.ndarray:
    """(n, 3) uint8 of values from 0 (red) to 1 (magenta), as rviz has them."""
    hue = np.clip(1.0 - values, 0.0, 1.0) * 5.0 + 1.0
    step = np.floor(hue).astype(int)
    rest = hue - step
    rest = np.where(step % 2 == 0, 1.0 - rest, rest)
    down, zero, one = 1.0 - rest, np.zeros_like(rest), np.ones_like(rest)
    # Which of (down, 0, 1) is red, green and blue in each of the five steps.
    table = np.stack([down, zero, one], axis=1)
    order = np.array([[0, 1, 2], [1, 0, 2], [1, 2, 0], [0, 2, 1], [2, 0, 1]])[
        np.clip(step - 1, 0, 4)]
    return (255 * np.take_along_axis(table, order, axis=1)).astype(np.uint8)


def between(values: np.ndarray, low: str, high: str) -> np.ndarray:
    """(n, 3) uint8 from one colour (0) to another (1)."""
    first, last = np.array(rgb(low), float), np.array(rgb(high), float)
    return (first + np.clip(values, 0.0, 1.0)[:, None] * (last - first)).astype(np.uint8)


def spread(values: np.ndarray, bounds: tuple[float, float] | None) -> np.ndarray:
    """Values scaled to 0..1 from these bounds, or from their own; NaN and infinity become 0."""
    values = np.where(np.isfinite(values), values, np.nan).astype(float)
    if bounds is None:
        known = values[~np.isnan(values)]
        bounds = (known.min(), known.max()) if known.size else (0.0, 1.0)
    span = bounds[1] - bounds[0]
    return np.nan_to_num((values - bounds[0]) / (span if span else 1.0), nan=0.0)
