"""Scores the missions of a drive by the robot's true poses, the models shown, and contacts."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import dropwhile, pairwise

import numpy as np

from run_session.files import find_package

WORLD = find_package("turtlebot3_gazebo") / "worlds" / "turtlebot3_autorace_2020.world"
PLAN = json.loads(WORLD.with_suffix(".json").read_text(encoding="utf-8"))  # m, rad
WAY = PLAN["lane"]["middle"]
HALF_LANE = 0.125  # m: the base is between the lines
LIGHT_X, BAR_Y = 1.25, 0.66  # m, of the base: its front is at the light, or before the bar
LANE_END = 0.8  # m, y just before the bar: the lane mission ends there
MAY_CHANGE = 0.5  # s: a green light or open bar shown this recently still counts
BAYS = {"east": (0.755, 0.8), "west": (0.205, 0.8)}  # m
IN_BAY = 0.08, 0.14  # m from a bay's middle along x and y
PARKED = 1.0  # s
STANDING = 0.005  # m between two samples
START = 0.70, 1.00  # m, range of x for a robot that has stopped at the red line
WHOSE = {"barrier": "lane", "traffic_bar": "bar", "unit_box": "bar", "tunnel": "tunnel",
         "turtlebot3_burger": "parking", "unit_sphere": "traffic_light",
         "traffic_light": "traffic_light"}  # prefix of a model's name: mission; others: lane
GROUND = ("course", "ground", "ground2")


@dataclass(frozen=True)
class Sample:
    """The robot's true position, and which models of the mission were in the world."""

    time: float  # s, simulated
    x: float  # m
    y: float
    shown: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Score:
    """One mission's: `why` it was not passed, None: it was; `time` in s since the drive began."""

    mission: str
    why: str | None
    time: float | None = None
    contacts: list[str] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether the mission was completed and nothing was touched."""
        return self.why is None


def off_lane(x: float, y: float) -> float:
    """Distance (m) from the lane's middle; 0 in the car park and in the tunnel."""
    if in_car_park(x, y) or in_tunnel(x, y):
        return 0.0
    place, begins, pieces = np.array((x, y)), np.array(WAY[:-1]), np.diff(WAY, axis=0)
    shares = ((place - begins) * pieces).sum(axis=1) / (pieces**2).sum(axis=1)
    nearest = begins + shares.clip(0.0, 1.0)[:, None] * pieces
    return float(np.linalg.norm(place - nearest, axis=1).min())


def in_car_park(x: float, y: float) -> bool:
    """Whether the point is in the car park or on the way there."""
    return 0.0 < x < 1.0 and 0.4 < y < 1.66


def in_tunnel(x: float, y: float) -> bool:
    """Whether the point is in the tunnel, or just before or behind it."""
    return -2.1 < x < 0.1 and -2.1 < y < 0.1


def score(samples: Sequence[Sample], contacts: dict[str, float], wanted: Sequence[str]
          ) -> list[Score]:
    """One for each wanted mission; `contacts`: touched models and the times of first contact, s."""
    found = []
    for mission in wanted:
        touched = [name for name in contacts if _whose(name) == mission]
        time, why = RULES[mission](samples)
        why = f"touched {', '.join(touched)}" if touched else why
        found.append(Score(mission, why, None if time is None else
                           round(time - samples[0].time, 1), touched))
    return found


def _whose(model: str) -> str:
    return next((mission for begin, mission in WHOSE.items() if model.startswith(begin)), "lane")


Found = tuple[float | None, str | None]  # time it ended, s, and why it was not passed


def _lane(samples: Sequence[Sample]) -> Found:
    for each in samples:
        if off_lane(each.x, each.y) > HALF_LANE:
            return each.time, f"left the lane at {each.x:.2f}, {each.y:.2f}"
        if each.x < -1.5 and each.y < LANE_END:
            return each.time, None
    return None, "did not come to its end"


def _waits_for(shown: str, said: str, place: str, is_there: Callable[[Sample], bool]
               ) -> Callable[[Sequence[Sample]], Found]:
    """The rule that a model is shown, or was up to MAY_CHANGE before, when the robot arrives."""
    def rule(samples: Sequence[Sample]) -> Found:
        come = next(filter(is_there, samples), None)
        if come is None:
            return None, f"did not come to the {place}"
        stood = any(shown in each.shown for each in samples
                    if come.time - MAY_CHANGE <= each.time <= come.time)
        return come.time, None if stood else f"did not wait for {said}"
    return rule


def _parking(samples: Sequence[Sample]) -> Found:
    stood, parked = 0.0, False
    for before, each in pairwise(samples):
        near = any(abs(each.x - x) < IN_BAY[0] and abs(each.y - y) < IN_BAY[1]
                   for x, y in BAYS.values())
        still = math.dist((before.x, before.y), (each.x, each.y)) < STANDING
        stood = stood + each.time - before.time if near and still else 0.0
        parked = parked or stood >= PARKED
        if parked and each.x < 0.2 and each.y > 1.6:
            return each.time, None
    return None, "did not come back to the lane" if parked else "stood in no bay"


def _tunnel(samples: Sequence[Sample]) -> Found:
    inside = list(dropwhile(lambda robot: not (
        in_tunnel(robot.x, robot.y) and robot.y < -0.2 and robot.x < -0.2), samples))
    if not inside:
        return None, "did not come into the tunnel"
    time = next((each.time for each in inside if each.x > 0.1 and each.y < -1.5), None)
    return time, None if time else "did not find the exit"


def _finish(samples: Sequence[Sample]) -> Found:
    after = dropwhile(lambda robot: robot.x >= -0.5 or robot.y >= -0.5, samples)  # from the tunnel
    for before, each in pairwise(after):
        if START[0] < each.x < START[1] and math.dist((before.x, before.y),
                                                      (each.x, each.y)) < STANDING:
            return each.time, None
    return None, "did not stop at the red line"


RULES: dict[str, Callable[[Sequence[Sample]], Found]] = {
    "lane": _lane,
    "traffic_light": _waits_for("traffic_light_green", "green", "light",
                                lambda robot: robot.x > LIGHT_X and robot.y < -1.5),
    "parking": _parking,
    "bar": _waits_for("traffic_bar_up", "the bar", "bar",
                      lambda robot: robot.x < -1.5 and 0.1 < robot.y < BAR_Y),
    "tunnel": _tunnel, "finish": _finish}
MISSIONS = tuple(RULES)
