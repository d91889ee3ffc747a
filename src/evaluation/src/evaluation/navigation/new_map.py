"""A round's map: saved in a folder of its own, it takes the old one's place when it is scored."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np

from evaluation.trial.report import write_json

FOLDER = "new_map"  # in that for results


def place_for_map(out: Path) -> Path:
    """The YAML file that a map is to be saved as, in an empty folder."""
    folder = out / FOLDER
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder / "map.yaml"


def keep_map(made: Path, map_in_world: np.ndarray) -> None:
    """Put it into the folder for results, with where it lies in the world: (3,), m and rad."""
    write_json({"map_in_world": map_in_world.tolist()}, made.with_suffix(".json"))
    folder = made.parent
    for path in folder.iterdir():
        path.replace(folder.parent / path.name)
    folder.rmdir()


def read_map_frame(path: Path) -> np.ndarray:
    """`map_in_world` (3,) from beside a map's YAML file; 0 where there is none."""
    for beside in (path.with_suffix(".json"), path.parent / "report.json"):  # of older runs
        try:
            found = np.array(json.loads(beside.read_text(encoding="utf-8"))["map_in_world"], float)
        except (OSError, ValueError, KeyError, TypeError):
            continue
        if found.shape == (3,):
            return found
    return np.zeros(3)
