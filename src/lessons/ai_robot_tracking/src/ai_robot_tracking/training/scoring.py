"""A model's accuracy on newly rendered worlds, with the node's own code, and its speed."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ai_robot_tracking.detection.model import Model
from ai_robot_tracking.training.drawing import Picture
from ai_robot_tracking.training.mean_average_precision import Found, Truth, overlaps

LEAST = 0.01  # lowest score of counted boxes, so that the curve is complete
CONFIDENCE, IOU = 0.25, 0.45  # the node's, for the confusion matrix
SPEED_RUNS = 40


@dataclass(frozen=True)
class Judged:
    """What a model found in images, and their true boxes."""

    found: list[Found]
    truth: list[Truth]


def judge(model: Model, pictures: Iterable[Picture]) -> Judged:
    """Run the model on all images as the node does."""
    found, truth = [], []
    for picture in pictures:
        seen = model.detect(picture.rgb, LEAST, IOU)
        found.append(Found(seen.boxes, seen.scores, seen.classes))
        labels = picture.labels
        truth.append(Truth(labels[:, 1:5].astype(float), labels[:, 0].astype(int),
                           labels[:, 5] > 0))
    return Judged(found, truth)


def confusion(judged: Judged, classes: int) -> np.ndarray:
    """(classes + 1, classes + 1) counts at the node's confidence: rows true, columns found.

    The last row is for background, the last column for objects that were not found.
    """
    table = np.zeros((classes + 1, classes + 1), int)
    for seen, real in zip(judged.found, judged.truth):
        sure = seen.scores >= CONFIDENCE
        boxes, labels = seen.boxes[sure], seen.classes[sure]
        common = overlaps(boxes, real.boxes)
        taken = np.zeros(len(real.boxes), bool)
        for index in range(len(boxes)):
            free = np.where(taken, 0.0, common[index])
            best = int(free.argmax()) if len(free) else -1
            if best >= 0 and free[best] >= 0.5:
                taken[best] = True
                if real.counts[best]:
                    table[real.classes[best], labels[index]] += 1
            else:
                table[classes, labels[index]] += 1
        for label in real.classes[~taken & real.counts]:
            table[label, classes] += 1
    return table


def recall_by_size(judged: Judged, edges: tuple[float, ...]) -> list[tuple[int, int]]:
    """For each range of box heights (px): how many objects there are, and how many were found."""
    tallies = [[0, 0] for _ in edges[:-1]]
    for seen, real in zip(judged.found, judged.truth):
        sure = seen.scores >= CONFIDENCE
        common = overlaps(seen.boxes[sure], real.boxes)
        same = seen.classes[sure][:, None] == real.classes[None]
        hit = ((common >= 0.5) & same).any(axis=0)
        for index in np.flatnonzero(real.counts):
            height = real.boxes[index, 3] - real.boxes[index, 1]
            place = int(np.searchsorted(edges, height, side="right")) - 1
            if 0 <= place < len(tallies):
                tallies[place][0] += 1
                tallies[place][1] += int(hit[index])
    return [(total, right) for total, right in tallies]


def milliseconds(model: Model, picture: np.ndarray) -> tuple[float, float]:
    """Median wall and mean processor time per image: fitted, run and decoded."""
    model.detect(picture, CONFIDENCE, IOU)
    walls, cpu = [], time.process_time()
    for _ in range(SPEED_RUNS):
        start = time.perf_counter()
        model.detect(picture, CONFIDENCE, IOU)
        walls.append(time.perf_counter() - start)
    return float(np.median(walls)) * 1e3, (time.process_time() - cpu) / SPEED_RUNS * 1e3
