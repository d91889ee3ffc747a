"""Rectangles of a picture, in coordinates and in tiles."""

import math

import numpy as np
import pytest

from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView, projection_matrix
from bullet_sim.rendering.visibility import TILE, is_empty, rectangles_of, tiles

VIEW = CameraView(100, 100, math.pi / 2, 1.0, 100.0, Pose())  # 90 degrees both ways


def box(low, high):
    """Corners (8, 3) in OpenGL's eye frame: x right, z backward."""
    return np.array([[high[axis] if number >> axis & 1 else low[axis] for axis in range(3)]
                     for number in range(8)])


def test_boxes_before_across_and_behind_the_near_plane_in_one_call():
    boxes = [box((-1, -2, -5), (1, 2, -4)),  # nearest corners at a depth of 4
             box((0.1, 0.1, -10), (0.5, 0.5, 5)),  # cut at 1 m: 0.5 wide there
             box((-1, -1, 2), (1, 1, 3))]
    found = rectangles_of(np.array(boxes), projection_matrix(VIEW))
    np.testing.assert_allclose(found[0], [[-0.25, -0.5], [0.25, 0.5]])
    np.testing.assert_allclose(found[1], [[0.01, 0.01], [0.5, 0.5]])
    assert is_empty(found).tolist() == [False, False, True]
    for one, together in zip(boxes, found, strict=True):
        np.testing.assert_array_equal(rectangles_of(one[None], projection_matrix(VIEW))[0],
                                      together)


@pytest.mark.parametrize("places", [
    [[[-0.5, -0.25], [0.5, 0.75]]], [[[-1.0, -1.0], [1.0, 1.0]]], [[[-1.0, 0.3], [-0.99, 1.0]]],
    [[[-0.9, -0.9], [-0.2, 0.3]], [[-0.3, -0.1], [0.2, 0.9]], [[0.7, -0.9], [0.8, -0.8]]]])
@pytest.mark.parametrize("extent", [[[-1.0, -1.0], [1.0, 1.0]], [[-0.61, -0.2], [0.4, 0.5]],
                                    [[0.99, 0.1], [1.0, 0.11]]])
def test_tiles_are_the_extent_once_and_say_where_the_places_are(places, extent):
    places, extent, size = np.array(places), np.array(extent), np.array([640, 400])
    count, inside = np.zeros((400, 640), int), np.zeros((400, 640), bool)
    for (left, first, width, height), there in tiles(places, extent, 640, 400):
        assert width > 0 and height > 0
        count[first:first + height, left:left + width] += 1
        inside[first:first + height, left:left + width] = there
    assert count.max() == 1

    def pixels(rectangle):
        low, high = (rectangle + 1) / 2 * size
        return np.s_[int(low[1]):math.ceil(high[1]), int(low[0]):math.ceil(high[0])]

    assert (count[pixels(extent)] == 1).all()
    wanted, needed = np.zeros_like(inside), np.zeros_like(inside)
    needed[pixels(extent)] = True
    for place in places:
        wanted[pixels(place)] = True
    for first, left in np.ndindex(7, 10):
        tile = np.s_[TILE * first:TILE * (first + 1), TILE * left:TILE * (left + 1)]
        assert (count[tile] == needed[tile].any()).all()
        assert (inside[tile] == (needed[tile].any() and wanted[tile].any())).all()
