"""Clouds of all layouts, and those that are none."""

import numpy as np
import pytest
from node_basics.point_cloud2 import BadCloud, positions, records
from sensor_msgs.msg import PointCloud2, PointField

POINTS = np.arange(12.0).reshape(2, 2, 3)


def cloud(kind="<f4", gap=b"gap!", **changes):
    """Two rows of two points, each row with bytes behind it."""
    size = np.dtype(kind).itemsize
    data = b"".join(row.astype(kind).tobytes() + gap for row in POINTS)
    message = PointCloud2(
        height=2, width=2, point_step=3 * size, row_step=6 * size + len(gap), data=data,
        is_bigendian=kind[0] == ">",
        fields=[PointField(axis, size * n, 8 if size == 8 else 7, 1)
                for n, axis in enumerate("xyz")])
    for name, value in changes.items():
        setattr(message, name, value)
    return message


@pytest.mark.parametrize("kind", ["<f4", ">f4", "<f8"])
@pytest.mark.parametrize("gap", [b"", b"gap!"])
def test_clouds_of_rows_with_gaps_and_byte_orders(kind, gap):
    assert positions(cloud(kind, gap)).tolist() == POINTS.reshape(4, 3).tolist()


def test_a_row_step_of_0_is_that_of_rows_without_gaps():
    assert positions(cloud(gap=b"", row_step=0)).tolist() == POINTS.reshape(4, 3).tolist()


def test_other_fields_are_read_too():
    message = cloud()
    message.fields.append(PointField("ring", 4, 4, 1))
    assert records(message)["ring"].dtype == "u2"


def test_fields_of_unknown_types_are_not_there():
    message = cloud()
    message.fields.append(PointField("odd", 4, 99, 1))
    assert records(message).dtype.names == ("x", "y", "z")


def test_a_field_outside_of_the_point_is_left_out():
    message = cloud()
    message.fields.append(PointField("intensity", 12, 7, 1))
    assert records(message).dtype.names == ("x", "y", "z")
    assert positions(message).tolist() == POINTS.reshape(4, 3).tolist()


def test_the_last_row_may_be_without_its_padding():
    whole = cloud()
    message = cloud(data=whole.data[:-len(b"gap!")])
    assert positions(message).tolist() == POINTS.reshape(4, 3).tolist()
    with pytest.raises(BadCloud, match="does not match width"):
        records(cloud(data=message.data[:-1]))


@pytest.mark.parametrize("changes", [
    {"width": 0, "row_step": 0}, {"height": 0}, {"width": 0, "height": 1, "point_step": 0},
])
def test_an_empty_cloud_has_no_points(changes):
    assert positions(cloud(data=b"", **changes)).shape == (0, 3)


@pytest.mark.parametrize("changes, said", [
    ({"width": 4_000_000_000}, "does not match width"), ({"data": b""}, "does not match width"),
    ({"row_step": 3}, "does not match width"), ({"height": 9}, "does not match width"),
    ({"fields": []}, "no field x, y, z; it needs x, y and z, and has none"),
    ({"fields": cloud().fields[:2]}, "no field z; it needs x, y and z, and has x, y"),
    ({"fields": [PointField(axis, 0, 0, 1) for axis in "xyz"]}, "no field x"),
    ({"point_step": 8}, "field z lies outside of the point_step of 8 bytes"),
    ({"fields": [PointField(axis, 1 << 31, 7, 1) for axis in "xyz"]}, "lies outside"),
])
def test_clouds_whose_sizes_do_not_fit_are_refused(changes, said):
    with pytest.raises(BadCloud, match=said):
        records(cloud(**changes))
