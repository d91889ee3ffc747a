"""Reads and checks the teacher's marking.yaml; an error is one line that names file and key."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

from node_basics.records import read_yaml, to_record

from run_session.failure import RunError

PASS_SHARE = 0.6  # of all points, where a file from before there was a pass line has none


@dataclass(frozen=True)
class Points:
    """The points of a case, and the values at which they are given."""

    finish: float
    line: float
    line_best_m: float
    line_worst_m: float
    speed: float
    speed_best_m_s: float
    speed_worst_m_s: float

    @property
    def most(self) -> float:
        return float(self.finish + self.line + self.speed)  # 100.0 in marks.csv


@dataclass(frozen=True)
class Limits:
    """Resource limits of a submission in one case."""

    start_s: float
    simulated_s: float
    wall_s: float
    answer_s: float
    unanswered: float
    timed_answer_s: float
    cpu_s: float
    memory_mb: float
    processes: float
    disk_mb: float
    output_mb: float


@dataclass(frozen=True)
class Rules:
    """A marking.yaml, key by key."""

    course: str
    program: tuple[str, ...]
    laps: int
    tracks: tuple[str, ...]
    seeds: int
    first_seed: int
    start_sideways_m: float
    start_turn_deg: float
    light: tuple[float, ...]
    camera: tuple[int, ...]
    points: Points
    pass_points: float
    limits: Limits
    may_publish: tuple[str, ...]
    may_call: tuple[str, ...]


def load_rules(path: Path) -> Rules:
    """Read a marking.yaml; RunError names file and key."""
    values = read_yaml(path, RunError)
    lacks = isinstance(values, dict) and "pass_points" not in values
    rules = to_record(Rules, {**values, "pass_points": 0.0} if lacks else values, path, RunError)
    if lacks:
        rules = dataclasses.replace(rules, pass_points=PASS_SHARE * rules.points.most)
    small = [key for key, value in dataclasses.asdict(rules.limits).items() if value <= 0]
    for wrong, what in (
            (len(rules.light) != 2 or not 0 < rules.light[0] <= rules.light[-1],
             "light: must be [least, most], more than 0"),
            (len(rules.camera) not in (0, 2) or 0 in rules.camera,
             "camera: must be [width, height] or []"),
            (not rules.program, "program: must name a file"),
            (rules.laps < 1, "laps: must be 1 or more"),
            (rules.seeds < 1, "seeds: must be 1 or more"),
            (not rules.points.most, "points: finish, line and speed are all 0"),
            (rules.pass_points > rules.points.most,
             f"pass_points: must be {rules.points.most:g} or less"),
            (small, f"limits.{''.join(small[:1])}: must be more than 0")):
        if wrong:
            raise RunError(f"{path}: {what}")
    tracks = tuple(str((path.parent / track).resolve()) for track in rules.tracks)
    return dataclasses.replace(rules, tracks=tracks)
