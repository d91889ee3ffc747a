"""Random textures: floors, walls, pictures on them, and the stop sign."""

from __future__ import annotations

import cv2
import numpy as np

SIDE_PX = 128
FLOOR_PX = 384


def any_colour(rng: np.random.Generator, saturated: bool = False) -> tuple[float, float, float]:
    """A random colour, RGB, each 0..1."""
    saturation = rng.uniform(0.65, 1.0) if saturated else rng.uniform(0.0, 0.8)
    hsv = (rng.uniform(0, 360), saturation, rng.uniform(0.35 if saturated else 0.1, 1.0))
    colour = cv2.cvtColor(np.array([[hsv]], np.float32), cv2.COLOR_HSV2RGB)[0, 0]
    return tuple(float(channel) for channel in colour)


def any_red(rng: np.random.Generator) -> tuple[float, float, float]:
    """A strong red."""
    return rng.uniform(0.6, 1), rng.uniform(0, 0.2), rng.uniform(0, 0.2)


def pattern(rng: np.random.Generator, side_px: int = SIDE_PX) -> np.ndarray:
    """(side, side, 3) uint8 RGB: a kind of surface in two colours, with some grain."""
    kind = rng.choice([_plain, _checks, _stripes, _bricks, _clouds, _shapes, _lane])
    first, second = (np.array(any_colour(rng)) for _ in range(2))
    mix = kind(rng, side_px).astype(np.float32)[..., None]
    image = first * (1 - mix) + second * mix
    grain = cv2.resize(rng.normal(0, 1, (side_px // 4, side_px // 4)).astype(np.float32),
                       (side_px, side_px))
    image = image + rng.uniform(0, 0.06) * grain[..., None]
    return (np.clip(image, 0, 1) * 255).round().astype(np.uint8)


def stop_face(rng: np.random.Generator) -> np.ndarray:
    """(128, 128, 3) uint8 RGB: red with a white rim and the word."""
    red = (int(rng.integers(140, 230)), int(rng.integers(0, 40)), int(rng.integers(0, 45)))
    image = np.full((128, 128, 3), red, np.uint8)
    turn = np.pi / 8 + np.arange(8) * np.pi / 4
    rim = 64 + 64 / np.cos(np.pi / 8) * np.stack([np.cos(turn), np.sin(turn)], 1) * 0.95
    cv2.polylines(image, [rim.round().astype(np.int32)], True, (245, 245, 245),
                  int(rng.integers(3, 8)), cv2.LINE_AA)
    size = rng.uniform(1.15, 1.4)
    (width, height), _ = cv2.getTextSize("STOP", cv2.FONT_HERSHEY_SIMPLEX, size, 5)
    place = (64 - width // 2, 64 + height // 2)
    cv2.putText(image, "STOP", place, cv2.FONT_HERSHEY_SIMPLEX, size, (245, 245, 245),
                int(rng.integers(4, 8)), cv2.LINE_AA)
    return image


def _plain(rng: np.random.Generator, side: int) -> np.ndarray:
    return np.zeros((side, side))


def _checks(rng: np.random.Generator, side: int) -> np.ndarray:
    cell = int(rng.integers(side // 32, side // 4))
    row, column = np.indices((side, side)) // cell
    return (row + column) % 2


def _stripes(rng: np.random.Generator, side: int) -> np.ndarray:
    row, column = np.indices((side, side))
    angle, period = rng.uniform(0, np.pi), rng.uniform(side / 30, side / 3)
    wave = np.sin((row * np.cos(angle) + column * np.sin(angle)) * 2 * np.pi / period)
    return wave > rng.uniform(-0.8, 0.8)


def _bricks(rng: np.random.Generator, side: int) -> np.ndarray:
    high, wide = (int(side * rng.uniform(*share)) for share in ((0.04, 0.12), (0.09, 0.25)))
    row, column = np.indices((side, side))
    column = column + (row // high % 2) * wide // 2
    thick = max(1, side // 128)
    return (row % high < thick) | (column % wide < thick)


def _clouds(rng: np.random.Generator, side: int) -> np.ndarray:
    total = np.zeros((side, side), np.float32)
    for cells in (3, 7, 17, 41):
        total += cv2.resize(rng.random((cells, cells), np.float32), (side, side),
                            interpolation=cv2.INTER_CUBIC) / np.sqrt(cells)
    return (total - total.min()) / (np.ptp(total) + 1e-6)


def _shapes(rng: np.random.Generator, side: int) -> np.ndarray:
    image = np.zeros((side, side), np.uint8)
    for _ in range(int(rng.integers(3, 14))):
        a, b = (tuple(int(v) for v in rng.integers(0, side, 2)) for _ in range(2))
        grey = int(rng.integers(60, 256))
        if rng.random() < 0.5:
            cv2.rectangle(image, a, b, grey, -1)
        else:
            cv2.circle(image, a, int(rng.integers(3, side // 5)), grey, -1, cv2.LINE_AA)
    return image / 255


def _lane(rng: np.random.Generator, side: int) -> np.ndarray:
    image = np.zeros((side, side), np.uint8)
    for _ in range(int(rng.integers(1, 4))):
        knots = rng.uniform(0, side, (4, 2))
        share = np.linspace(0, 1, 40)[:, None]
        weights = ((1 - share) ** 3, 3 * share * (1 - share) ** 2, 3 * share**2 * (1 - share),
                   share**3)
        curve = sum(w * knot for w, knot in zip(weights, knots))
        cv2.polylines(image, [curve.astype(np.int32)], False, 255, int(rng.integers(2, 9)),
                      cv2.LINE_AA)
    return image / 255
