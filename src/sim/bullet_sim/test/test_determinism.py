"""One seed, one run: in every process, whoever looks and however often."""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from bullet_sim.description import Noise
from bullet_sim.sensors.image_effects import ImageNoise
from bullet_sim.world import World

RUN = Path(__file__).with_name("repeated_run.py")
# name: PYTHONHASHSEED, seed, every how many frames are looked at
RUNS = {
    "first": (1, 7, 1),
    "again": (2, 7, 1),
    "seldom looked at": (3, 7, 3),
    "another seed": (1, 8, 1),
}


def run(hash_seed: int, seed: int, look_every: int) -> dict[str, str]:
    done = subprocess.run([sys.executable, RUN, str(seed), str(look_every)], check=True,
                          env=os.environ | {"PYTHONHASHSEED": str(hash_seed)},
                          stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def runs():
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(RUNS, pool.map(lambda values: run(*values), RUNS.values()), strict=True))


@pytest.mark.parametrize("other", ["again", "seldom looked at"])
def test_the_same_seed_is_the_same_run_bit_by_bit(runs, other):
    assert runs["first"] == runs[other]


def test_another_seed_changes_the_noise_and_nothing_else(runs):
    first, other = runs["first"], runs["another seed"]
    changed = {kind for kind in first if first[kind] != other[kind]}
    assert changed == {"scans", "images"}


def test_random_numbers_depend_on_seed_name_and_tick_alone():
    worlds = [World(seed=1), World(seed=1), World(seed=2)]

    def draw(world, name, tick):
        return world.random(name, tick).normal(size=4).tolist()

    first = draw(worlds[0], "a", 5)
    draw(worlds[1], "a", 4)
    draw(worlds[1], "b", 5)
    assert draw(worlds[1], "a", 5) == first
    others = [draw(worlds[0], "b", 5), draw(worlds[0], "a", 6), draw(worlds[2], "a", 5)]
    assert first not in others
    assert len({tuple(numbers) for numbers in others}) == 3
    worlds[0].step(6)
    assert worlds[0].random("a").normal(size=4).tolist() == others[1]
    for world in worlds:
        world.close()


# --- noise on pictures

SHAPE = (240, 320, 3)
LEVELS = SHAPE[0] * SHAPE[1] * SHAPE[2]


def noisy(level: float, mean: float = 0.0, stddev: float = 0.03, frames: int = 4) -> np.ndarray:
    """Frames of one grey level with noise on them, (frames, h, w, 3) uint8."""
    noise = ImageNoise(Noise("gaussian", mean, stddev), SHAPE, np.random.default_rng(0))
    flat = np.full(SHAPE, level, np.uint8)
    return np.stack([noise.add(flat, np.random.default_rng([1, n])) for n in range(frames)])


def test_the_noise_has_its_mean_and_deviation():
    difference = noisy(100, mean=0.02).astype(float) - 100
    chance = 5 * 0.03 * 255 / LEVELS ** 0.5
    assert difference.mean() == pytest.approx(0.02 * 255, abs=chance)
    rounding = 1 / 12  # variance of rounding to whole levels
    assert difference.std() ** 2 == pytest.approx((0.03 * 255) ** 2 + rounding, rel=0.01)


def test_a_mean_of_1_is_full_brightness():
    assert (noisy(0, mean=1.0, stddev=0.0) == 255).all()


def test_it_is_gaussian():
    difference = (noisy(128)[0].astype(float) - 128) / (0.03 * 255)
    for deviations, share in ((1.0, 0.6827), (2.0, 0.9545), (3.0, 0.9973)):
        # A level stands for all that is rounded to it: compare at the edge between two levels.
        edge = (np.floor(deviations * 0.03 * 255) + 0.5) / (0.03 * 255)
        expected = share + (edge - deviations) * 2 * np.exp(-deviations ** 2 / 2) / 2.5066
        assert np.mean(np.abs(difference) < edge) == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize("neighbour", [(0, 0, 0, 1), (0, 0, 1, 0), (0, 1, 0, 0), (1, 0, 0, 0)],
                         ids=["channel", "right", "below", "next frame"])
def test_neighbours_are_independent(neighbour):
    difference = noisy(128).astype(float) - 128
    one = difference[tuple(slice(None, -step or None) for step in neighbour)]
    other = difference[tuple(slice(step, None) for step in neighbour)]
    correlation = np.corrcoef(one.ravel(), other.ravel())[0, 1]
    assert abs(correlation) < 5 / one.size ** 0.5


@pytest.mark.parametrize("level", [0, 255])
def test_black_and_white_stay_within_the_grey_levels(level):
    found = noisy(level, stddev=0.1).astype(int)
    assert np.mean(found == level) == pytest.approx(0.5, abs=0.03)
    assert np.abs(found - level).max() < 128  # wrapped round, it would be at the other end
