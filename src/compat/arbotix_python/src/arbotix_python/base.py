"""A differential base that does at once what is commanded: upstream's simulation of one."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

UPSTREAM_JOINTS = ("base_l_wheel_joint", "base_r_wheel_joint")
CONTROLLER_TYPE = "diff_controller"


class SettingsError(ValueError):
    """A controller's parameters cannot be used; the text says which and why."""


@dataclass(frozen=True)
class BaseSettings:
    """Parameters of one diff_controller. Wheels turn only where all of the last three are known."""

    rate: float = 10.0  # Hz, of odometry
    base_frame_id: str = "base_link"
    odom_frame_id: str = "odom"
    timeout: float = math.inf  # s, how long a command counts
    base_width: float = 0.0  # m between the wheels
    wheel_radius: float = 0.0  # m
    joint_names: tuple[str, str] = UPSTREAM_JOINTS  # left, right


def read_settings(name: str, given: dict) -> BaseSettings:
    """From the parameters of controller `name`; SettingsError where they make no base."""
    if not isinstance(given, dict):
        raise SettingsError(f"controller {name} is {given!r:.40}: "
                            f"it must be a table that begins with type: {CONTROLLER_TYPE}")
    if given.get("type") != CONTROLLER_TYPE:
        raise SettingsError(f"controller {name} is of type {given.get('type')}: "
                            f"only {CONTROLLER_TYPE} is simulated")
    missing = [key for key in ("base_width", "ticks_meter") if key not in given]
    if missing:
        raise SettingsError(f"controller {name} has no {' and no '.join(missing)}")
    numbers = {}
    for key in ("rate", "timeout", "base_width", "wheel_radius"):
        if key in given:
            numbers[key] = positive(f"controller {name}: {key}", given[key])
    frames = {key: str(given[key]).lstrip("/") for key in ("base_frame_id", "odom_frame_id")
              if key in given}
    joints = given.get("joint_names", UPSTREAM_JOINTS)
    if not isinstance(joints, (list, tuple)) or len(joints) != 2:
        raise SettingsError(f"controller {name}: joint_names is {joints}: "
                            "it must be a list of two, [left, right]")
    return BaseSettings(**numbers, **frames, joint_names=tuple(map(str, joints)))


def positive(what: str, value: object) -> float:
    """`value` as a number; SettingsError says what is none."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not (number > 0 and math.isfinite(number)):
        raise SettingsError(f"{what} is {value}: it must be a number above 0")
    return number


@dataclass
class Base:
    """Where the base and its wheels are in the odometry frame, and how fast they move."""

    settings: BaseSettings
    x: float = 0.0  # m
    y: float = 0.0  # m
    yaw: float = 0.0  # rad
    speed: float = 0.0  # m/s forward
    turn: float = 0.0  # rad/s to the left
    wheel_angles: list[float] = field(default_factory=lambda: [0.0, 0.0])  # rad; left, right
    commanded_at: float = -math.inf  # s

    def command(self, speed: float, turn: float, now: float) -> None:
        self.speed, self.turn, self.commanded_at = speed, turn, now

    def advance(self, now: float, elapsed: float) -> None:
        """Along the arc that speed and turn make in `elapsed` s; an old command ends after it."""
        turned, driven = self.turn * elapsed, self.speed * elapsed
        # The chord of an arc lies at half its angle and is shorter by sin(a) / a.
        half = turned / 2
        chord = driven * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
        self.x += chord * math.cos(self.yaw + half)
        self.y += chord * math.sin(self.yaw + half)
        self.yaw = math.remainder(self.yaw + turned, math.tau)
        for side, speed in enumerate(self.wheel_speeds()):
            self.wheel_angles[side] += speed * elapsed
        if now - self.commanded_at > self.settings.timeout:
            self.speed = self.turn = 0.0

    def wheel_speeds(self) -> tuple[float, float]:
        """rad/s of the left and the right wheel; zero, as upstream's, without a radius."""
        radius = self.settings.wheel_radius
        if not radius:
            return 0.0, 0.0
        beside = self.turn * self.settings.base_width / 2
        return (self.speed - beside) / radius, (self.speed + beside) / radius
