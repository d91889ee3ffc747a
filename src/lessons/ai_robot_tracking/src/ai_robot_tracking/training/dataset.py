"""Sets of rendered images as files: fitted into the network's input, with their boxes, augmented.

A file is an .npz: `images` (n, INPUT_HEIGHT, INPUT_WIDTH, 3) uint8 RGB, `labels` (m, 7) float32 of
picture, class, left, top, right, bottom (px of the input), counts (0 or 1), `first`, the seed of
the first image (the others follow it), and `count`, the number of images.
"""

from __future__ import annotations

import math
import multiprocessing
import time
from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import cv2
import numpy as np

from ai_robot_tracking.detection.decoding import PADDING, letterbox
from ai_robot_tracking.training import TrainingError
from ai_robot_tracking.training.drawing import draw_picture
from bullet_sim.errors import SimulationError
from bullet_sim.rendering.renderer import Renderer, open_renderer

INPUT_WIDTH, INPUT_HEIGHT = 320, 256  # px
DAMAGED = (OSError, ValueError, KeyError, IndexError, TypeError, EOFError, BadZipFile)
PICTURE, CLASS, BOX, COUNTS = 0, 1, slice(2, 6), 6  # columns of labels
SHARD = 500  # images per file
TRAIN_FIRST, TEST_FIRST = 1_000_000, 3_000_000  # seeds; sets never overlap


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
    images, labels, firsts, count = [], [], [], 0
    for path in sorted(folder.glob(f"{name}-*.npz")):
        if most is not None and count >= most:
            break
        try:
            with np.load(path) as file:
                images.append(file["images"])
                labels.append(file["labels"] + np.eye(1, 7, PICTURE, dtype=np.float32) * count)
                firsts.append(int(file["first"]))
        except DAMAGED as error:
            raise OSError(f"{path}: not a set of images; draw it again: {error}") from error
        count += len(images[-1])
    if not images:
        raise FileNotFoundError(f"{folder}: no images {name}-*.npz; draw them first")
    rows = np.concatenate(labels)
    kept = count if most is None else most
    return PictureSet(np.concatenate(images)[:kept], rows[rows[:, PICTURE] < kept], firsts[0])


ZOOM = (0.6, 1.7)
LEAST_KEPT = 0.5  # of a box's area, for it to still count
SMALLEST_PX = 6.0  # of the input: 12 px in an image twice as wide


def augmented(
    rng: np.random.Generator, image: np.ndarray, labels: np.ndarray, size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """A changed image of `size` (height, width), with its labels (n, 6); see `drawing.FIELDS`.

    A smaller image gets a part of the original, or all of it scaled down.
    """
    labels = labels.copy()
    if rng.random() < 0.5:
        labels[:, [1, 3]] = image.shape[1] - labels[:, [3, 1]]
        image = image[:, ::-1]
    smaller = math.sqrt(size[1] / image.shape[1])  # between all of it and its original scale
    factor = smaller * math.exp(rng.uniform(*np.log(ZOOM))) if rng.random() < 0.7 else smaller
    if factor != 1 or size != image.shape[:2]:
        image, labels = _zoomed(rng, np.ascontiguousarray(image), labels, factor, *size)
    return _relit(rng, image), labels


def _zoomed(rng: np.random.Generator, image: np.ndarray, labels: np.ndarray, factor: float,
            height: int, width: int) -> tuple[np.ndarray, np.ndarray]:
    slack = np.array((width, height)) - np.array(image.shape[1::-1]) * factor
    offset = slack * rng.uniform(0, 1, 2)
    matrix = np.array([[factor, 0, offset[0]], [0, factor, offset[1]]])
    image = cv2.warpAffine(image, matrix, (width, height), borderValue=(PADDING,) * 3)
    whole = labels[:, 1:5] * factor + np.tile(offset, 2)
    labels[:, 1:5] = np.clip(whole, 0, (width, height) * 2)
    sides, before = labels[:, 3:5] - labels[:, 1:3], whole[:, 2:] - whole[:, :2]
    kept = sides.prod(axis=1) >= LEAST_KEPT * before.prod(axis=1)
    labels[:, 5] *= kept & (sides.min(axis=1) >= SMALLEST_PX)
    return image, labels[sides.min(axis=1) > 1]


def _relit(rng: np.random.Generator, image: np.ndarray) -> np.ndarray:
    gain = rng.uniform(0.6, 1.35) * rng.uniform(0.88, 1.12, 3)
    table = np.arange(256)[:, None] / 255 * gain
    table = np.clip(table, 0, 1) ** math.exp(rng.uniform(-0.25, 0.25)) * 255
    image = cv2.LUT(np.ascontiguousarray(image), table.round().astype(np.uint8)[None])
    if rng.random() < 0.15:
        image = cv2.blur(image, (2, 2))
    if rng.random() < 0.2:
        grain = rng.standard_normal(image.shape, np.float32) * rng.uniform(1, 7)
        image = cv2.add(image, grain, dtype=cv2.CV_8U)
    return image


Shard = tuple[Path, range]  # a file, and the seeds of its images


def open_drawing() -> Renderer:
    """The renderer of all cameras; TrainingError without it."""
    try:
        return open_renderer()
    except SimulationError as error:
        raise TrainingError(f"{error}; images are rendered in .venv: rosrun ai_robot_tracking "
                       "train_detector.py ...") from error


def draw_set(folder: Path, name: str, first: int, count: int, jobs: int = 1) -> None:
    """Write the images of the seeds from `first` on; existing files are kept.

    `jobs` processes render at a time; the files do not depend on their number.
    """
    open_drawing().close()  # so that a missing renderer is reported once
    folder.mkdir(parents=True, exist_ok=True)
    shards = [(folder / f"{name}-{start}.npz", range(start, min(start + SHARD, first + count)))
              for start in range(first, first + count, SHARD)]
    wanted = [shard for shard in shards if not holds(shard[0], len(shard[1]))]
    done, began = count - sum(len(seeds) for _, seeds in wanted), time.monotonic()
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        for drawn in pool.imap_unordered(_draw_shard, wanted):
            done += drawn
            print(f"{name}: {done} of {count} images, {time.monotonic() - began:.0f} s",
                  flush=True)


def _draw_shard(shard: Shard) -> int:
    path, seeds = shard
    renderer = open_drawing()
    pictures = [draw_picture(renderer, seed) for seed in seeds]
    renderer.close()
    write_set(path, [fitted(picture.rgb, picture.labels) for picture in pictures], seeds.start)
    return len(pictures)
