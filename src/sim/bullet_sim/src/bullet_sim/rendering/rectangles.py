"""Rectangles of a picture: where boxes in the world appear, in whole pixels, and what is around.

They are (2, 2): x y of two corners, -1..1 from side to side. One whose first corner is not below
the second in both is empty.
"""

from __future__ import annotations

import numpy as np

NOWHERE = np.array([[1.0, 1.0], [-1.0, -1.0]])
_CUBE = np.array([(corner, corner | bit) for bit in (1, 2, 4) for corner in range(8)
                  if not corner & bit]).T  # (2, 12): which of eight corners edges go between

Scissor = tuple[int, int, int, int]  # px: left, first row, width, height


def is_empty(rectangles: np.ndarray) -> np.ndarray:
    """(...) bool of (..., 2, 2)."""
    return (rectangles[..., 0, :] >= rectangles[..., 1, :]).any(axis=-1)


def rectangles_of(corners: np.ndarray, clip_world: np.ndarray) -> np.ndarray:
    """(n, 2, 2): where in the picture boxes with these corners (n, 8, 3) are, cut to it.

    The three bits of a corner's number tell on which of opposite sides it is. `clip_world` (4, 4)
    is world to clip coordinates of the picture.
    """
    clip = corners @ clip_world[:, :3].T + clip_world[:, 3]
    ahead = clip[..., 2] + clip[..., 3]  # not below 0: not behind the near plane
    one, other = clip[:, _CUBE[0]], clip[:, _CUBE[1]]
    cut = (ahead[:, _CUBE[0]] < 0) != (ahead[:, _CUBE[1]] < 0)
    rise = np.where(cut, ahead[:, _CUBE[0]] - ahead[:, _CUBE[1]], 1.0)
    share = np.where(cut, ahead[:, _CUBE[0]] / rise, 0.0)
    points = np.concatenate([clip, one + share[..., None] * (other - one)], axis=1)
    valid = np.concatenate([ahead >= 0, cut], axis=1)[..., None]
    place = points[..., :2] / np.where(valid, points[..., 3:], 1.0)
    low, high = np.where(valid, place, 1.0), np.where(valid, place, -1.0)
    return np.stack([np.maximum(low.min(axis=1), -1.0), np.minimum(high.max(axis=1), 1.0)], axis=1)


def inside_and_around(place: np.ndarray, width: int,
                      height: int) -> tuple[Scissor, list[Scissor]]:
    """A rectangle in whole pixels, and what is left of the picture around it."""
    size = np.array([width, height])
    left, first = np.floor((place[0] + 1) / 2 * size).astype(int).tolist()
    right, last = np.ceil((place[1] + 1) / 2 * size).astype(int).tolist()
    around = [(0, 0, width, first), (0, last, width, height - last),
              (0, first, left, last - first), (right, first, width - right, last - first)]
    return (left, first, right - left, last - first), [one for one in around if min(one[2:]) > 0]
