"""Axes and buttons as a velocity: held button, axis times scale."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

LINEAR, ANGULAR = ("x", "y", "z"), ("roll", "pitch", "yaw")
Velocity = tuple[float, float, float, float, float, float]  # linear x y z, angular x y z
ZERO: Velocity = (0.0,) * 6


@dataclass
class Teleop:
    """Upstream's parameters and defaults; a number for an axis means x, or yaw.

    `parameters`: as they stand under the node's name. Raises ValueError for one of another kind.
    """

    parameters: Mapping[str, object]
    _stopped: bool = False
    _axes: dict[str, int] = field(default_factory=dict)
    _scales: dict[bool, dict[str, float]] = field(default_factory=lambda: {False: {}, True: {}})

    def __post_init__(self):
        self.enable = int(self._number("enable_button", 0))
        self.turbo = int(self._number("enable_turbo_button", -1))
        self._read("linear", LINEAR, "x", 1, 1.0)
        self._read("angular", ANGULAR, "yaw", 0, None)

    def command(self, axes: Sequence[float], buttons: Sequence[int]) -> Velocity | None:
        """What to publish: m/s and rad/s; one zero when the button comes up, then None."""
        if self.turbo >= 0 and _pressed(buttons, self.turbo):
            return self._scaled(axes, turbo=True)
        if _pressed(buttons, self.enable):
            return self._scaled(axes, turbo=False)
        if self._stopped:
            return None
        self._stopped = True
        return ZERO

    def _scaled(self, axes: Sequence[float], turbo: bool) -> Velocity:
        self._stopped = False
        scales = self._scales[turbo]
        return tuple(axes[self._axes[name]] * scales[name]
                     if name in scales and 0 <= self._axes.get(name, -1) < len(axes) else 0.0
                     for name in (*LINEAR, *ANGULAR))

    def _read(self, kind: str, names: Sequence[str], only: str, axis: int,
              turbo: float | None) -> None:
        mapped = self.parameters.get(f"axis_{kind}")
        if isinstance(mapped, Mapping):
            self._axes.update({name: int(mapped[name]) for name in names if name in mapped})
            for is_turbo, key in ((False, f"scale_{kind}"), (True, f"scale_{kind}_turbo")):
                scales = self.parameters.get(key, {})
                if not isinstance(scales, Mapping):
                    raise ValueError(f"{key} is {scales!r}, and axis_{kind} has names: give one "
                                     f"scale for each, {key}: {{{only}: 0.5}}")
                self._scales[is_turbo].update({n: float(scales[n]) for n in names if n in scales})
            return
        self._axes[only] = int(self._number(f"axis_{kind}", axis))
        scale = self._number(f"scale_{kind}", 0.5)
        self._scales[False][only] = scale
        self._scales[True][only] = self._number(f"scale_{kind}_turbo",
                                                scale if turbo is None else turbo)

    def _number(self, name: str, default: float) -> float:
        value = self.parameters.get(name, default)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"{name} is {value!r}, not a number")
        return value


def _pressed(buttons: Sequence[int], number: int) -> bool:
    return 0 <= number < len(buttons) and bool(buttons[number])
