"""How a person crosses: waits, walks to the kerb, looks, walks across. No ROS; m, s, m/s."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

CAR_FRONT, CAR_REAR = 0.20, 0.16  # m before and behind base_footprint
BESIDE = 1.0  # m from the lane's middle: farther away, the car is not on this road
STANDS = 0.05  # m/s: below this, the car counts as standing


@dataclass(frozen=True)
class Crossing:
    """One zebra in the world: its centre, the lane's heading, and its dimensions."""

    x: float
    y: float
    heading: float  # rad
    length: float  # along the road
    kerb: float  # from the lane's middle, where a person looks
    far: float  # from the lane's middle, where a person waits

    def within(self, x: float, y: float) -> tuple[float, float]:
        """A place in the world as metres along the lane and to its left, from the centre."""
        dx, dy = x - self.x, y - self.y
        cos, sin = math.cos(self.heading), math.sin(self.heading)
        return cos * dx + sin * dy, cos * dy - sin * dx


@dataclass(frozen=True)
class Habits:
    """Behaviour of people; pairs are bounds of a uniform distribution, drawn for each walk."""

    pause: tuple[float, float] = (2.0, 8.0)  # between two walks
    speed: tuple[float, float] = (0.6, 1.2)
    look: tuple[float, float] = (0.2, 0.8)  # how long a person at least looks at the kerb
    gap: float = 0.9  # nobody steps out while a moving car's front is nearer than this to the zebra
    near: float = 0.0  # a walk only starts when the car is at most this near; 0: at any time


class Stage(Enum):
    """What a person is doing."""

    WAITING = "waiting"
    COMING = "walking to the kerb"
    LOOKING = "looking"
    CROSSING = "crossing"


class Walker:
    """One person, walking from side to side. Same seed and same car: same walks."""

    def __init__(self, crossing: Crossing, habits: Habits, random: np.random.Generator):
        self._crossing, self._habits, self._random = crossing, habits, random
        self.stage = Stage.WAITING
        self.side = -1  # where this walk started, or the next will: 1 is left of the lane
        self._speed = self._until = self._trigger = 0.0
        self._now = 0.0
        self._draw(0.0)

    def step(self, now: float, place: tuple[float, float],
             car: tuple[float, float, float] | None) -> float:
        """Speed to the lane's left, m/s; `place`: the person's x, y; `car`: x, y, speed."""
        if now < self._now:  # a simulation was reset
            self._draw(now)
        self._now = now
        across = self._crossing.within(*place)[1] * self.side  # falls from far to -far
        gap = self._gap(car)
        if self.stage is Stage.WAITING and now >= self._until and self._car_comes(gap):
            self.stage = Stage.COMING
        if self.stage is Stage.COMING and across <= self._crossing.kerb:
            self.stage = Stage.LOOKING
            self._until = now + self._random.uniform(*self._habits.look)
        if self.stage is Stage.LOOKING and now >= self._until and self._is_safe(gap, car):
            self.stage = Stage.CROSSING
        if self.stage is Stage.CROSSING and across <= -self._crossing.far:
            self.stage, self.side = Stage.WAITING, -self.side
            self._draw(now)
        walks = self.stage in (Stage.COMING, Stage.CROSSING)
        return -self.side * self._speed if walks else 0.0

    def _draw(self, now: float) -> None:
        habits = self._habits
        self._until = now + self._random.uniform(*habits.pause)
        self._speed = self._random.uniform(*habits.speed)
        self._trigger = self._random.uniform(habits.gap, max(habits.near, habits.gap))

    def _gap(self, car: tuple[float, float, float] | None) -> float:
        """m from the car's front to the zebra; negative: on it; infinite: past it or elsewhere."""
        if car is None:
            return math.inf
        along, left = self._crossing.within(*car[:2])
        half = self._crossing.length / 2
        if abs(left) > BESIDE or along - CAR_REAR > half:
            return math.inf
        return -half - (along + CAR_FRONT)

    def _car_comes(self, gap: float) -> bool:
        return not self._habits.near or 0 < gap <= self._trigger

    def _is_safe(self, gap: float, car: tuple[float, float, float] | None) -> bool:
        stands = car is not None and abs(car[2]) < STANDS
        return gap > self._habits.gap or (stands and gap > 0)
