"""A new map: saved in a folder of its own, it replaces the old one when it has been scored."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np

from evaluation.trial.report import write_json

FOLDER = "new_map"  # in the folder for results


def place_for_map(out: Path) -> Path:
    """Path of the YAML file to save a map as, in an emptied folder."""
    folder = out / FOLDER
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder / "map.yaml"


def keep_map(made: Path, map_in_world: np.ndarray) -> None:
    """Move it to the folder for results, with its frame's pose in the world (3,), m and rad."""
    write_json({"map_in_world": map_in_world.tolist()}, made.with_suffix(".json"))
    folder = made.parent
    for path in folder.iterdir():
        path.replace(folder.parent / path.name)
    folder.rmdir()


def read_map_frame(path: Path) -> np.ndarray:
    """`map_in_world` (3,) from the file beside a map's YAML file; zeros if there is none."""
    for beside in (path.with_suffix(".json"), path.parent / "report.json"):  # the 2nd: older runs
        try:
            found = np.array(json.loads(beside.read_text(encoding="utf-8"))["map_in_world"], float)
        except (OSError, ValueError, KeyError, TypeError):
            continue
        if found.shape == (3,):
            return found
    return np.zeros(3)
