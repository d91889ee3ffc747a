"""Sets of rendered images as files: fitted into the network's input, with their boxes.

A file is an .npz: `images` (n, INPUT_HEIGHT, INPUT_WIDTH, 3) uint8 RGB, `labels` (m, 7) float32 of
picture, class, left, top, right, bottom (px of the input), counts (0 or 1), `first`, the seed of
the first image (the others follow it), and `count`, the number of images.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from ai_robot_tracking.detection.letterbox import letterbox

INPUT_WIDTH, INPUT_HEIGHT = 320, 256  # px
DAMAGED = (OSError, ValueError, KeyError, IndexError, TypeError, EOFError, BadZipFile)
PICTURE, CLASS, BOX, COUNTS = 0, 1, slice(2, 6), 6  # columns of labels
SHARD = 500  # images per file
TRAIN_FIRST, CHECK_FIRST, TEST_FIRST = 1_000_000, 2_000_000, 3_000_000  # seeds; sets never overlap


@dataclass(frozen=True)
class PictureSet:
    """Images and boxes; see the module's docstring."""

    images: np.ndarray
    labels: np.ndarray
    first: int

    def __len__(self) -> int:
        return len(self.images)


def fitted(rgb: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """An image and its labels (see `drawing.Picture`), fitted into the network's input."""
    image, placement = letterbox(rgb, INPUT_WIDTH, INPUT_HEIGHT)
    moved = labels.copy()
    moved[:, 1:5] = moved[:, 1:5] * placement.scale + (placement.left, placement.top) * 2
    return image, moved


def write_set(path: Path, pictures: list[tuple[np.ndarray, np.ndarray]], first: int) -> None:
    """Write fitted images to one file, which is written completely or not at all."""
    rows = [np.column_stack([np.full(len(labels), number), labels])
            for number, (_, labels) in enumerate(pictures)]
    unfinished = path.with_suffix(".part.npz")
    np.savez(unfinished, images=np.stack([image for image, _ in pictures]),
             labels=np.concatenate(rows).astype(np.float32), first=first, count=len(pictures))
    unfinished.replace(path)


def holds(path: Path, count: int) -> bool:
    """Whether the file exists and is intact, with `count` images."""
    try:
        with np.load(path) as file:
            return int(file["count"]) == count
    except DAMAGED:
        return False


def read_sets(folder: Path, name: str, most: int | None = None) -> PictureSet:
    """All files of a set as one, in the order of their seeds; at most `most` images.

    FileNotFoundError if there are none, OSError if one is damaged.
    """
    images, labels, count, first = [], [], 0, None
    for path in sorted(folder.glob(f"{name}-*.npz")):
        if most is not None and count >= most:
            break
        try:
            with np.load(path) as file:
                rows = file["labels"].copy()
                rows[:, PICTURE] += count
                images.append(file["images"])
                labels.append(rows)
                first = int(file["first"]) if first is None else first
        except DAMAGED as error:
            raise OSError(f"{path}: not a set of images; draw it again: {error}") from error
        count += len(images[-1])
    if first is None:
        raise FileNotFoundError(f"{folder}: no images {name}-*.npz; draw them first")
    together = PictureSet(np.concatenate(images), np.concatenate(labels), first)
    if most is None or most >= count:
        return together
    kept = together.labels[together.labels[:, PICTURE] < most]
    return PictureSet(together.images[:most], kept, first)
