"""Tolerances of a joint's distance from its trajectory, on the way and at the end."""

from __future__ import annotations

from dataclasses import dataclass, field

from bullet_sim.control.trajectory.segment import Waypoint


@dataclass(frozen=True)
class Tolerance:
    """Maximum errors of one joint; 0: not checked."""

    position: float = 0.0  # rad or m
    velocity: float = 0.0
    acceleration: float = 0.0

    def violation(self, error: Waypoint) -> str | None:
        """The name of the quantity that is out of bounds; None if none is."""
        for name in ("position", "velocity", "acceleration"):
            bound, value = getattr(self, name), getattr(error, name)
            if bound > 0.0 and value is not None and abs(value) > bound:
                return f"{name} error {value:.6g}, tolerance {bound:.6g}"
        return None

    def replaced(self, position: float, velocity: float, acceleration: float) -> Tolerance:
        """With the tolerances of a goal, see `chosen`."""
        return Tolerance(chosen(position, self.position), chosen(velocity, self.velocity),
                         chosen(acceleration, self.acceleration))


@dataclass(frozen=True)
class GoalTolerances:
    """Tolerances of all joints by name."""

    path: dict[str, Tolerance] = field(default_factory=dict)
    goal: dict[str, Tolerance] = field(default_factory=dict)
    time: float = 0.0  # s after the end within which the goal tolerances must be met


def chosen(wish: float, default: float) -> float:
    """A goal's value: positive replaces the default, negative means none, 0 keeps the default."""
    if wish > 0.0:
        return wish
    return 0.0 if wish < 0.0 else default
