"""Scans of walls whose distance is known."""

import math

import numpy as np
import pytest
from depthimage_to_laserscan.scan import BadDepth, Pinhole, rows_of, scan_angles, scan_ranges

CAMERA = Pinhole(focal=100.0, center_x=100.0, center_y=50.0, width=201, height=100)


def test_angles_reach_from_edge_to_edge():
    angles = scan_angles(CAMERA)
    assert (angles.first, angles.last) == (-math.pi / 4, math.pi / 4)
    assert angles.count == 201
    assert angles.step == pytest.approx(math.pi / 2 / 200)


@pytest.mark.parametrize("depth", [np.full((100, 201), 2.0, np.float32),
                                   np.full((100, 201), 2000, np.uint16)])
def test_a_wall_across_is_nearest_in_the_middle(depth):
    angles = scan_angles(CAMERA)
    ranges = scan_ranges(depth, CAMERA, 1, 0.45, 10.0)
    seen = np.flatnonzero(np.isfinite(ranges))
    assert ranges[100] == pytest.approx(2.0, abs=1e-6)
    assert ranges[[0, 200]] == pytest.approx([2 * math.sqrt(2)] * 2, abs=0.02)
    across = ranges[seen] * np.cos(angles.first + seen * angles.step)
    assert across == pytest.approx(np.full(len(seen), 2.0), abs=0.04)  # within one step's angle
    assert len(seen) > 150  # at the edges two columns share an angle, in the middle some are left


def test_what_is_left_in_the_image_is_left_of_the_robot():
    depth = np.full((100, 201), 5.0, np.float32)
    depth[:, :50] = 1.0
    ranges = scan_ranges(depth, CAMERA, 1, 0.45, 10.0)
    assert np.nanmax(ranges[-40:]) < 1.5 and np.nanmin(ranges[:100]) > 4.9


def test_of_several_rows_the_nearest_counts():
    depth = np.full((100, 201), 5.0, np.float32)
    depth[47, 100] = 1.0
    assert scan_ranges(depth, CAMERA, 1, 0.45, 10.0)[100] == 5.0
    assert scan_ranges(depth, CAMERA, 10, 0.45, 10.0)[100] == 1.0


def test_what_was_not_seen():
    depth = np.full((100, 201), np.nan, np.float32)
    depth[50, 100], depth[50, 90], depth[50, 80] = 0.2, 20.0, np.inf
    depth[49] = depth[50]
    ranges = scan_ranges(depth, CAMERA, 1, 0.45, 10.0)
    assert np.isinf(ranges).sum() == 1 and np.isnan(ranges).sum() == 200
    assert np.isnan(scan_ranges(np.zeros((100, 201), np.uint16), CAMERA, 1, 0.45, 10.0)).all()


def test_rows_lie_around_the_axis_and_must_fit():
    assert rows_of(CAMERA, 1) == slice(50, 51)  # upstream halves in whole rows
    assert rows_of(CAMERA, 100) == slice(0, 100)
    for height in (0, 101):
        with pytest.raises(BadDepth, match=f"scan_height {height} does not fit"):
            rows_of(CAMERA, height)
