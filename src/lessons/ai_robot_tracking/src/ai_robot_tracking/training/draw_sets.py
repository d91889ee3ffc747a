"""Renders the sets of images that a network is trained on."""

from __future__ import annotations

import multiprocessing
import time
from pathlib import Path

from ai_robot_tracking.training import TrainingError
from ai_robot_tracking.training.dataset import SHARD, fitted, holds, write_set
from ai_robot_tracking.training.drawing import draw_picture
from bullet_sim.errors import SimulationError
from bullet_sim.rendering.renderer import Renderer, open_renderer

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
