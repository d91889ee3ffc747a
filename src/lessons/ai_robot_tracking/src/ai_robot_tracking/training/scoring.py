"""A model's accuracy on newly rendered worlds, with the node's own code, and its speed.

Mean average precision: how well the detected boxes agree with the true ones.

For each class, the boxes detected in all images are sorted by score. One is correct if it overlaps
a true box of its class by at least `overlap`, and no box with a higher score was matched to that
one; a box that overlaps one that does not count is ignored. The area under the curve of precision
over recall, made non-increasing, is the class's average precision; the result is the classes' mean.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ai_robot_tracking.detection.decoding import Detections
from ai_robot_tracking.detection.model import Model
from ai_robot_tracking.training.drawing import Picture


@dataclass(frozen=True)
class Truth:
    """The true boxes of one image."""

    boxes: np.ndarray  # (n, 4) left, top, right, bottom, px
    classes: np.ndarray  # (n,) int
    counts: np.ndarray  # (n,) bool; false: neither missed nor a false detection


def overlaps(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(n, m) intersection over union of boxes (n, 4) and (m, 4)."""
    low = np.maximum(first[:, None, :2], second[None, :, :2])
    high = np.minimum(first[:, None, 2:], second[None, :, 2:])
    common = np.clip(high - low, 0, None).prod(axis=2)
    areas = [(boxes[:, 2:] - boxes[:, :2]).prod(axis=1) for boxes in (first, second)]
    return common / np.maximum(areas[0][:, None] + areas[1][None] - common, 1e-9)


def average_precision(
    found: Sequence[Detections], truth: Sequence[Truth], label: int, overlap: float = 0.5
) -> float:
    """Average precision of one class over all images, 0..1; nan if it has no boxes."""
    scores, right, total = [], [], 0
    for seen, real in zip(found, truth, strict=True):
        of_class, wanted = seen.classes == label, real.classes == label
        total += int((wanted & real.counts).sum())
        hits = _hits(seen.boxes[of_class], seen.scores[of_class], real.boxes[wanted],
                     real.counts[wanted], overlap)
        scores.append(seen.scores[of_class][hits >= 0])
        right.append(hits[hits >= 0])
    if total == 0:
        return float("nan")
    hits = np.concatenate(right)[np.argsort(-np.concatenate(scores), kind="stable")]
    precision = np.cumsum(hits) / np.arange(1, len(hits) + 1)
    falling = np.maximum.accumulate(precision[::-1])[::-1]
    return float((falling * hits).sum() / total)


def mean_average_precision(
    found: Sequence[Detections], truth: Sequence[Truth], classes: int, overlap: float = 0.5
) -> float:
    """The mean over the classes that have boxes."""
    each = [average_precision(found, truth, label, overlap) for label in range(classes)]
    return float(np.nanmean(each))


def _hits(boxes: np.ndarray, scores: np.ndarray, real: np.ndarray, counts: np.ndarray,
          overlap: float) -> np.ndarray:
    """(n,) 1: correct, 0: wrong, -1: ignored; in the given order."""
    hits = np.zeros(len(boxes), int)
    common = overlaps(boxes, real)
    free = counts.copy()
    for index in np.argsort(-scores, kind="stable"):
        candidates = np.where(free, common[index], 0.0)
        if len(real) and candidates.max() >= overlap:
            free[candidates.argmax()] = False
            hits[index] = 1
        elif len(real) and np.where(counts, 0.0, common[index]).max() >= overlap:
            hits[index] = -1
    return hits


LEAST = 0.01  # lowest score of counted boxes, so that the curve is complete
CONFIDENCE, IOU = 0.25, 0.45  # the node's, for the confusion matrix
SPEED_RUNS = 40


@dataclass(frozen=True)
class Judged:
    """What a model found in images, and their true boxes."""

    found: list[Detections]
    truth: list[Truth]


def judge(model: Model, pictures: Iterable[Picture]) -> Judged:
    """Run the model on all images as the node does."""
    found, truth = [], []
    for picture in pictures:
        found.append(model.detect(picture.rgb, LEAST, IOU))
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
    heights, hits = [], []
    for seen, real in zip(judged.found, judged.truth):
        sure = seen.scores >= CONFIDENCE
        same = seen.classes[sure][:, None] == real.classes[None]
        hit = ((overlaps(seen.boxes[sure], real.boxes) >= 0.5) & same).any(axis=0)
        heights.append((real.boxes[:, 3] - real.boxes[:, 1])[real.counts])
        hits.append(hit[real.counts])
    height, hit = np.concatenate(heights), np.concatenate(hits)
    within = [(low <= height) & (height < high) for low, high in pairwise(edges)]
    return [(int(one.sum()), int(hit[one].sum())) for one in within]


def milliseconds(model: Model, picture: np.ndarray) -> tuple[float, float]:
    """Median wall and mean processor time per image: fitted, run and decoded."""
    model.detect(picture, CONFIDENCE, IOU)
    walls, cpu = [], time.process_time()
    for _ in range(SPEED_RUNS):
        start = time.perf_counter()
        model.detect(picture, CONFIDENCE, IOU)
        walls.append(time.perf_counter() - start)
    return float(np.median(walls)) * 1e3, (time.process_time() - cpu) / SPEED_RUNS * 1e3
