"""What each key does to the robot's velocity, and how smoothly the velocity follows."""

from __future__ import annotations

from dataclasses import dataclass, replace

LINEAR_STEP = 0.01  # m/s per key
ANGULAR_STEP = 0.1  # rad/s per key
LINEAR_SLOPE = 0.005  # m/s per message
ANGULAR_SLOPE = 0.05  # rad/s per message
LIMITS = {  # model -> (m/s, rad/s)
    "burger": (0.22, 2.84),
    "waffle": (0.26, 1.82),
    "waffle_pi": (0.26, 1.82),
}
STEPS = {
    "w": (LINEAR_STEP, 0.0),
    "x": (-LINEAR_STEP, 0.0),
    "a": (0.0, ANGULAR_STEP),
    "d": (0.0, -ANGULAR_STEP),
}
STOP_KEYS = (" ", "s")


@dataclass(frozen=True)
class KeyedSpeeds:
    """Velocities asked for, and those that are sent; m/s forward and rad/s to the left."""

    linear_target: float = 0.0
    angular_target: float = 0.0
    linear: float = 0.0
    angular: float = 0.0


def limits(model: str) -> tuple[float, float]:
    """The model's highest speeds (m/s, rad/s); an unknown model gets the burger's."""
    return LIMITS.get(model, LIMITS["burger"])


def press(drive: KeyedSpeeds, key: str, highest: tuple[float, float]) -> KeyedSpeeds:
    """After this key; one that means nothing changes nothing."""
    if key in STOP_KEYS:
        return KeyedSpeeds()
    if key not in STEPS:
        return drive
    forward, left = STEPS[key]
    return replace(
        drive,
        linear_target=clamp(drive.linear_target + forward, highest[0]),
        angular_target=clamp(drive.angular_target + left, highest[1]),
    )


def smooth(drive: KeyedSpeeds) -> KeyedSpeeds:
    """One message later: what is sent has come a slope nearer to what was asked for."""
    return replace(
        drive,
        linear=approach(drive.linear, drive.linear_target, LINEAR_SLOPE),
        angular=approach(drive.angular, drive.angular_target, ANGULAR_SLOPE),
    )


def clamp(value: float, highest: float) -> float:
    # Rounded, because sums of 0.01 gather digits that a person would read in the terminal.
    return round(min(max(value, -highest), highest), 6)


def approach(value: float, target: float, slope: float) -> float:
    return round(min(max(target, value - slope), value + slope), 6)
