"""How far the marker was dragged, as a velocity."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Drag:
    """Upstream's parameters: scale in 1/s for each linear axis, limits in m/s and rad/s."""

    scale: Mapping[str, float] = field(default_factory=lambda: {"x": 1.0})
    fastest: Mapping[str, float] = field(default_factory=lambda: {"x": 1.0})
    backwards: Mapping[str, float] = field(default_factory=lambda: {"x": -1.0})
    angular_scale: float = 2.2
    max_angular: float = 2.2

    def velocity(self, position: tuple[float, float, float],
                 orientation: tuple[float, float, float, float],
                 ) -> tuple[tuple[float, float, float], float]:
        """(linear x, y, z in m/s; yaw rate in rad/s) of the marker's place in the robot's frame.

        position in m, orientation a quaternion (x, y, z, w); only its yaw counts.
        """
        linear = tuple(self._axis(axis, offset)
                       for axis, offset in zip(AXES, position, strict=True))
        x, y, z, w = orientation
        yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        turn = max(-self.max_angular, min(self.max_angular, self.angular_scale * yaw))
        return linear, turn

    def _axis(self, axis: str, offset: float) -> float:
        if axis not in self.scale:
            return 0.0
        value = self.scale[axis] * offset
        return max(self.backwards.get(axis, -math.inf), min(self.fastest.get(axis, math.inf),
                                                            value))


def read_axes(value: object, name: str) -> dict[str, float]:
    """The numbers of parameter `name`: one means x, a mapping names its axes; or ValueError."""
    entries = value if isinstance(value, Mapping) else {"x": value}
    for axis, number in entries.items():
        if axis not in AXES or isinstance(number, bool) or not isinstance(number, int | float):
            raise ValueError(f"{name} is {value!r}; it is a number, or has numbers for x, y, z")
    return {axis: float(number) for axis, number in entries.items()}
