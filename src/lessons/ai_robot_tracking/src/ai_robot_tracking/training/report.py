"""The training report: how the shipped model was trained, and its scores."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np

from ai_robot_tracking.detection.decoding import Detections
from ai_robot_tracking.detection.messages import annotated
from ai_robot_tracking.detection.model import Model, ModelError
from ai_robot_tracking.training import CLASSES, TrainingError
from ai_robot_tracking.training.dataset import TEST_FIRST, open_drawing
from ai_robot_tracking.training.drawing import Picture, draw_picture
from ai_robot_tracking.training.scoring import (
    CONFIDENCE,
    IOU,
    Judged,
    average_precision,
    confusion,
    judge,
    mean_average_precision,
    milliseconds,
    recall_by_size,
)

SIZES_PX = (12.0, 20.0, 32.0, 64.0, 128.0, 480.1)
SHEET_COLUMNS, SHEET_ROWS, TILE = 4, 2, (320, 240)  # px
STRICT = 0.75
CURVE_POINTS = 12


def write_report(path: Path, count: int) -> float:
    """Write MODEL-training.md and MODEL.png next to the model; returns the mAP at an IoU of 0.5."""
    log = path.with_name(f"{path.stem}-training.json")
    try:
        model, done = Model(path), json.loads(log.read_text(encoding="utf-8"))
    except ModelError as error:
        raise TrainingError(str(error)) from error
    except (OSError, ValueError) as error:
        raise TrainingError(f"{log}: {error}; it is written by: train_detector.py train") from error
    if tuple(model.names) != CLASSES:
        raise TrainingError(f"{path}: its classes are {model.names}, not {list(CLASSES)}")
    renderer = open_drawing()
    pictures = [draw_picture(renderer, seed) for seed in range(TEST_FIRST, TEST_FIRST + count)]
    judged = judge(model, pictures)
    lines = [*_head(done), *_scores(judged, count), *_confusions(judged), *_sizes(judged),
             *_speed(model, pictures[0])]
    path.with_name(f"{path.stem}-training.md").write_text("\n".join(lines) + "\n",
                                                          encoding="utf-8")
    cv2.imwrite(str(path.with_suffix(".png")), _sheet(model, pictures),
                [cv2.IMWRITE_PNG_COMPRESSION, 9])
    score = _mean(judged, 0.5)
    print("\n".join(_scores(judged, count)), flush=True)
    return score


def _head(done: dict) -> list[str]:
    lines = [
        "# Training report of the shipped detector", "",
        "Written by `train_detector.py report`; do not edit.", "",
        f"- A network of {done['rounds'][0]['weights']} weights; SHA-256 of the model "
        f"{done['model_sha256'][:16]}….",
        "- An object counts if both sides of its box are at least 12 px in an image 640 px wide, "
        "and at least half of it is visible.", ""]
    for number, one in enumerate(done["rounds"], start=1):
        plan = ", ".join(f"{name} {value:g}" for name, value in one["plan"].items())
        boxes = ", ".join(f"{count} {name}" for name, count in one["boxes"].items())
        first = one["first_seed"]
        lines += [
            f"## Round {number}", "",
            f"- Trained on {one['pictures']} images rendered by our own simulator, seeds {first} "
            f"to {first + one['pictures'] - 1}, SHA-256 {one['pictures_sha256'][:16]}….",
            f"- Boxes to be found in them: {boxes}.",
            f"- Plan: {plan}.",
            f"- {one['cpu_minutes']} minutes of one core ({one['wall_minutes']} by the clock), "
            f"torch {one['torch']}, on {one['processor']}.", "", *_curve(one["curve"]), ""]
    return lines


def _scores(judged: Judged, count: int) -> list[str]:
    rows = []
    for label, name in enumerate(CLASSES):
        total = sum(int(((real.classes == label) & real.counts).sum()) for real in judged.truth)
        rows.append([name, total, *(
            _text(average_precision(judged.found, judged.truth, label, overlap))
            for overlap in (0.5, STRICT))])
    means = [_text(_mean(judged, overlap)) for overlap in (0.5, STRICT)]
    return [f"## Score on {count} images of worlds that it never saw", "",
            f"Seeds {TEST_FIRST} to {TEST_FIRST + count - 1}.", "",
            *_table(["class", "to be found", "AP@0.5", f"AP@{STRICT:g}"], rows),
            f"| **mean** | | **{means[0]}** | **{means[1]}** |", ""]


def _confusions(judged: Judged) -> list[str]:
    rows = [[name, *row] for name, row in zip([*CLASSES, "nothing"],
                                              confusion(judged, len(CLASSES)))]
    rows[-1][-1] = ""
    return [f"## Confusion matrix at confidence {CONFIDENCE:g}", "",
            *_table(["true \\ found", *CLASSES, "not found"], rows), ""]


def _sizes(judged: Judged) -> list[str]:
    rows = [(f"{low:g} to {math.floor(high)}", total,
             f"{100 * right / total:.0f} %" if total else "")
            for (total, right), (low, high) in zip(recall_by_size(judged, SIZES_PX),
                                                   pairwise(SIZES_PX))]
    return [f"## Found at confidence {CONFIDENCE:g}, by the height of the box", "",
            *_table(["px", "to be found", "found"], rows), ""]


def _speed(model: Model, picture: Picture) -> list[str]:
    wall, cpu = milliseconds(model, picture.rgb)
    height, width = picture.rgb.shape[:2]
    return ["## Speed", "",
            f"One image of {width}x{height} px on one thread, fitted, run and decoded: "
            f"{cpu:.1f} ms of processor time ({1000 / cpu:.0f} images/s on an "
            f"idle core), {wall:.1f} ms by the clock at a load of {os.getloadavg()[0]:.1f} on "
            f"{os.cpu_count()} cores.", ""]


def _curve(curve: list[list[float]]) -> list[str]:
    picked = sorted({round(place) for place in np.linspace(0, len(curve) - 1, CURVE_POINTS)})
    return _table(["step", *(curve[place][0] for place in picked)],
                  [["loss", *(f"{curve[place][1]:.2f}" for place in picked)]])


def _table(heads: Sequence[object], rows: Iterable[Sequence[object]]) -> list[str]:
    lines = ["| " + " | ".join(map(str, row)) + " |" for row in (heads, *rows)]
    return [lines[0], "|---" * len(heads) + "|", *lines[1:]]


def _mean(judged: Judged, overlap: float) -> float:
    return mean_average_precision(judged.found, judged.truth, len(CLASSES), overlap)


def _text(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.3f}"


def _sheet(model: Model, pictures: list[Picture]) -> np.ndarray:
    """The first images as the node annotates them, side by side, BGR."""
    tiles = []
    for picture in pictures:
        if picture.rgb.shape[0] * 4 != picture.rgb.shape[1] * 3 or not len(picture.labels):
            continue
        found: Detections = model.detect(picture.rgb, CONFIDENCE, IOU)
        tiles.append(cv2.resize(annotated(picture.rgb, found, model.names), TILE,
                                interpolation=cv2.INTER_AREA)[..., ::-1])
        if len(tiles) == SHEET_COLUMNS * SHEET_ROWS:
            break
    if len(tiles) < SHEET_COLUMNS:
        return tiles[0] if tiles else pictures[0].rgb[..., ::-1]
    full = len(tiles) // SHEET_COLUMNS * SHEET_COLUMNS
    rows = [np.hstack(tiles[row:row + SHEET_COLUMNS]) for row in range(0, full, SHEET_COLUMNS)]
    return np.vstack(rows)
