"""Points whose ranges are known, and scans whose points are."""

import math

import numpy as np
import pytest
from pointcloud_to_laserscan.projection import (
    BadCloud,
    Settings,
    points_of,
    ranges_of,
    rotation,
    xyz_of,
)

FIELDS = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7)]


def test_upstreams_defaults():
    settings = Settings()
    assert settings.count == 360
    ranges = ranges_of(np.array([[1.0, 0.0, 0.0], [2.0, 0.0, 0.1]]), settings)
    assert ranges[180] == 2.0  # the floor at z = 0 is not above min_height
    assert np.isinf(np.delete(ranges, 180)).all()


def test_nearest_of_an_angle_within_heights_and_ranges():
    settings = Settings(min_height=-1.0, max_height=1.0, angle_min=-math.pi / 2,
                        angle_max=math.pi / 2, angle_increment=math.pi / 4, range_min=0.5,
                        range_max=10.0, use_inf=False)
    points = np.array([[3.0, 0.1, 0.0], [4.0, 0.1, 0.0], [0.1, 0.1, 0.0], [2.0, 0.1, 5.0],
                       [0.1, -6.0, 0.0], [-1.0, 0.0, 0.0], [np.nan, 0.0, 0.0], [50.0, 0.1, 0.0],
                       [0.0, 7.0, 0.0]])
    assert ranges_of(points, settings) == pytest.approx(
        [math.hypot(0.1, 6.0), 11.0, math.hypot(3.0, 0.1), 7.0])


def test_angles_that_are_none_are_refused():
    with pytest.raises(ValueError, match="angle_increment 0 leave no angles"):
        Settings(angle_increment=0.0)


def test_scan_to_points_and_back():
    ranges = np.array([1.0, np.inf, 2.0, 0.05, np.nan])
    points, index = points_of(ranges, 0.0, math.pi / 2, 0.1, 10.0)
    assert index.tolist() == [0, 2]
    assert points == pytest.approx(np.array([[1, 0, 0], [-2, 0, 0]], float))


def test_a_quarter_turn_to_the_left():
    half = math.sqrt(0.5)
    assert rotation(0, 0, half, half) @ [1, 0, 0] == pytest.approx([0, 1, 0])


def test_clouds_of_rows_with_gaps_and_other_byte_orders():
    points = np.arange(12, dtype=">f4").reshape(2, 2, 3)
    data = b"".join(row.tobytes() + b"gap!" for row in points)
    read = xyz_of(data, FIELDS, 2, 2, 12, 28, True)
    assert read == pytest.approx(points.reshape(4, 3))


def test_clouds_that_are_none():
    with pytest.raises(BadCloud, match="no field z; it has x, y"):
        xyz_of(b"", FIELDS[:2], 1, 1, 12, 12, False)
    with pytest.raises(BadCloud, match="2 rows of 2 points of 12 bytes, and has 5 bytes"):
        xyz_of(b"short", FIELDS, 2, 2, 12, 24, False)
    assert xyz_of(b"", FIELDS, 0, 0, 12, 0, False).shape == (0, 3)


@pytest.mark.parametrize("field", [("x", 0, 0), ("z", 10, 7)])
def test_a_field_that_no_point_can_hold_is_named(field):
    fields = [entry for entry in FIELDS if entry[0] != field[0]] + [field]
    with pytest.raises(BadCloud, match=f"field {field[0]} has type {field[2]} at byte {field[1]}"):
        xyz_of(bytes(12), fields, 1, 1, 12, 12, False)


@pytest.mark.parametrize("wrong", [{"angle_min": "a"}, {"use_inf": "yes"}, {"range_max": True}])
def test_a_parameter_of_another_kind_is_named(wrong):
    with pytest.raises(ValueError, match=f"parameter {next(iter(wrong))} is "):
        Settings(**wrong)
