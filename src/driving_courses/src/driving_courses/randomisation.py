"""What may differ from episode to episode, and what a generator draws for one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from driving_courses.errors import CourseError
from evaluation.lap import RACE, Disturbance

Range = tuple[float, float]
FACTORS = ("light", "friction", "camera_noise")  # that are never negative


@dataclass(frozen=True)
class Randomisation:
    """From, to; evenly distributed. Without any, every episode begins alike."""

    light: Range = (1.0, 1.0)  # times the world's own
    friction: Range = (1.0, 1.0)  # times each surface's own
    camera_noise: Range = (0.0, 0.0)  # standard deviation; 1 is full brightness
    sideways: Range = (0.0, 0.0)  # m beside the start, positive to the left
    along: Range = (0.0, 0.0)  # m along the line from the start
    turn: Range = (0.0, 0.0)  # rad from the line's direction, positive to the left
    tracks: tuple[int, ...] = ()  # seeds of random tracks, one of which is drawn; (): the course's

    @classmethod
    def of(cls, options: Randomisation | Mapping[str, Any] | None) -> Randomisation:
        """From a mapping; CourseError names the key that is unknown or no range."""
        if isinstance(options, Randomisation):
            return options
        known, found = [field.name for field in fields(cls)], {}
        for key, value in (options or {}).items():
            if key not in known:
                raise CourseError(f"randomise: unknown key {key!r}; there are: {', '.join(known)}")
            found[key] = _seeds(value) if key == "tracks" else _range(key, value)
        return cls(**found)


# As the race's trials disturb a lap (evaluation.lap).
TRIALS = Randomisation(
    light=RACE.light, camera_noise=RACE.camera_noise, sideways=(-RACE.sideways, RACE.sideways),
    along=(-RACE.along, RACE.along), turn=(-RACE.turn, RACE.turn))


@dataclass(frozen=True)
class Episode:
    """What was drawn for one."""

    seed: int  # of all noise
    track: int | None  # a random track's seed; None: the course's own
    friction: float  # times each surface's own
    start: Disturbance


def draw(ranges: Randomisation, random: np.random.Generator) -> Episode:
    """One episode; draws as many numbers whatever the ranges are."""
    seed, choice = int(random.integers(2**31)), float(random.random())
    values = {name: float(random.uniform(*getattr(ranges, name)))
              for name in ("light", "friction", "camera_noise", "sideways", "along", "turn")}
    friction = values.pop("friction")
    tracks = ranges.tracks
    track = tracks[int(choice * len(tracks))] if tracks else None
    return Episode(seed, track, friction, Disturbance(**values))


def _range(key: str, value: Any) -> Range:
    try:
        low, high = (float(end) for end in value)
    except (TypeError, ValueError):
        low = high = math.nan
    if not -math.inf < low <= high < math.inf or (key in FACTORS and low < 0):
        raise CourseError(f"randomise: {key}: must be (least, greatest), is {value!r}")
    return low, high


def _seeds(value: Any) -> tuple[int, ...]:
    try:
        seeds = tuple(value)
    except TypeError:
        seeds = (None,)
    if not all(type(seed) is int and seed >= 0 for seed in seeds):
        raise CourseError(f"randomise: tracks: must be whole numbers, is {value!r}")
    return seeds
