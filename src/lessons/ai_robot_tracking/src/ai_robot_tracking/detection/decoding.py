"""Fits images into a network's input, and decodes YOLO's outputs to boxes: arrays alone.

Two layouts, for one image and C classes:
- v5: (1, N, 5 + C), a row per candidate: centre x, centre y, width, height in px of the input,
objectness, and C class scores; the score is objectness times class score.
- v8: (1, 4 + C, N), a column per candidate: the same four, and C class scores.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

PADDING = 114  # grey level of the padding with which YOLO networks are trained


@dataclass(frozen=True)
class Placement:
    """The image's place in the network's input: input = image * scale + offset, in px."""

    scale: float
    left: int
    top: int


def letterbox(picture: np.ndarray, width: int, height: int) -> tuple[np.ndarray, Placement]:
    """The (h, w, 3) uint8 image, evenly scaled and centred in (height, width, 3) of grey."""
    rows, columns = picture.shape[:2]
    scale = min(height / rows, width / columns)
    inner = (max(1, round(columns * scale)), max(1, round(rows * scale)))
    # An odd pixel of padding goes to the right or the bottom.
    placement = Placement(scale, (width - inner[0]) // 2, (height - inner[1]) // 2)
    if (columns, rows) != inner:
        picture = cv2.resize(picture, inner, interpolation=cv2.INTER_LINEAR)
    padded = np.full((height, width, 3), PADDING, np.uint8)
    padded[placement.top:placement.top + inner[1],
           placement.left:placement.left + inner[0]] = picture
    return padded, placement


def to_picture(boxes: np.ndarray, placement: Placement, width: int, height: int) -> np.ndarray:
    """Boxes (n, 4) of left, top, right, bottom in the input, in px of an image of that size.

    Parts outside the image are cut off.
    """
    offset = (placement.left, placement.top) * 2
    return np.clip((boxes - offset) / placement.scale, 0, (width, height) * 2)


V5, V8 = "v5", "v8"
MOST_CANDIDATES = 3000  # those with the highest scores; more would only cost time


@dataclass(frozen=True)
class Detections:
    """The detections in one image, highest score first."""

    boxes: np.ndarray  # (n, 4) float, left, top, right, bottom, px
    scores: np.ndarray  # (n,) float, 0..1
    classes: np.ndarray  # (n,) int

    def __len__(self) -> int:
        return len(self.scores)


def layout_of(shape: tuple[int, ...], class_count: int | None) -> tuple[str, int]:
    """Layout and number of classes of an output of this shape; ValueError if it is neither.

    If the number of classes is unknown, the longer of the two axes is taken as the candidates.
    """
    if len(shape) != 3 or shape[0] != 1:
        raise ValueError(f"its output has shape {shape}")
    if class_count is None:
        layout, width = (V8, shape[1]) if shape[1] < shape[2] else (V5, shape[2])
        count = width - (4 if layout == V8 else 5)
        if count < 1:
            raise ValueError(f"its output has shape {shape}")
        return layout, count
    fits = [layout for layout, width, extra in ((V8, shape[1], 4), (V5, shape[2], 5))
            if width == extra + class_count]
    if not fits:
        raise ValueError(f"its output has shape {shape}, and its names are {class_count}")
    return fits[0], class_count


def decode(output: np.ndarray, layout: str, confidence: float, iou: float) -> Detections:
    """Boxes in px of the network's input, from one raw output (1, ., .) float.

    Keeps candidates that score above `confidence` (0..1) and do not overlap a higher-scoring box of
    their class by more than `iou` (0..1). Drops those that are not finite or have no area.
    """
    table = output[0].T if layout == V8 else output[0]
    if layout == V8:
        scores = table[:, 4:]
    else:
        table = table[table[:, 4] > confidence]  # a product of scores is at most its factor
        with np.errstate(invalid="ignore", over="ignore"):  # non-finite values are dropped below
            scores = table[:, 5:] * table[:, 4:5]
    if not len(table):
        return nothing()
    classes = scores.argmax(axis=1)
    best = scores[np.arange(len(scores)), classes]
    kept = (best > confidence) & np.isfinite(best) & np.isfinite(table[:, :4]).all(axis=1)
    kept &= (table[:, 2] > 0) & (table[:, 3] > 0)
    rows = np.flatnonzero(kept)
    rows = rows[np.argsort(-best[rows], kind="stable")][:MOST_CANDIDATES]
    boxes, best, classes = corners(table[rows, :4]), best[rows], classes[rows]
    chosen = suppress(boxes, classes, iou)
    return Detections(boxes[chosen], best[chosen].astype(float), classes[chosen])


def nothing() -> Detections:
    """The result for an image without detections."""
    return Detections(np.empty((0, 4)), np.empty(0), np.empty(0, int))


def corners(boxes: np.ndarray) -> np.ndarray:
    """(n, 4) float64 left, top, right, bottom from middle x, middle y, width, height."""
    boxes = boxes.astype(float)
    half = boxes[:, 2:] / 2
    return np.concatenate([boxes[:, :2] - half, boxes[:, :2] + half], axis=1)


def suppress(boxes: np.ndarray, classes: np.ndarray, iou: float) -> np.ndarray:
    """Rows (k,) to keep of boxes (n, 4) in order of score: non-maximum suppression by class."""
    areas = (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
    alive, kept = np.arange(len(boxes)), []
    while len(alive):
        first, others = alive[0], alive[1:]
        kept.append(first)
        low = np.maximum(boxes[first, :2], boxes[others, :2])
        high = np.minimum(boxes[first, 2:], boxes[others, 2:])
        common = np.clip(high - low, 0, None).prod(axis=1)
        shared = common > iou * (areas[first] + areas[others] - common)
        alive = others[~(shared & (classes[others] == classes[first]))]
    return np.array(kept, int)
