"""A linear law from features to an action, as a JSON file: what the example learns."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from driving_courses.errors import CourseError


@dataclass(frozen=True)
class LinearPolicy:
    """action = bias + weights @ features, within low and high."""

    course: str  # whose features it is for
    action: str  # twist or ackermann
    weights: list[list[float]]  # (2, features): speed (m/s), turn (rad/s or rad)
    bias: list[float]  # (2,)
    low: list[float]
    high: list[float]
    score: dict[str, Any]  # of a lap in the environment

    def act(self, features: np.ndarray) -> tuple[float, float]:
        """What to do about features (n,): m/s, and rad/s or rad."""
        wanted = np.array(self.bias) + np.array(self.weights) @ features
        speed, turn = np.clip(wanted, self.low, self.high).tolist()
        return speed, turn

    def save(self, path: Path) -> None:
        """Write it as JSON."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(asdict(self), indent=1) + "\n", encoding="utf-8")


def load_policy(path: str | Path) -> LinearPolicy:
    """The policy of a file; CourseError names file and key."""
    try:
        values = json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise CourseError(f"{path}: no policy: {error}") from error
    known = [field.name for field in fields(LinearPolicy)]
    if not isinstance(values, dict) or set(values) != set(known):
        raise CourseError(f"{path}: no policy: it must have the keys {', '.join(known)}")
    try:
        shapes = [np.asarray(values[key], float).shape for key in ("bias", "low", "high")]
        rows = np.asarray(values["weights"], float)
        if shapes != [(2,)] * 3 or rows.ndim != 2 or len(rows) != 2:
            raise ValueError("not two rows")
    except (TypeError, ValueError, OverflowError) as error:
        raise CourseError(f"{path}: weights, bias, low, high: {error}") from error
    return LinearPolicy(**values)
