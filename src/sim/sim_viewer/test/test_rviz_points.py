"""What scans, clouds and maps are drawn as: known answers, and what is broken is refused."""

import math

import numpy as np
import pytest
from map_msgs.msg import OccupancyGridUpdate
from rviz_messages import (
    HITS,
    cloud,
    grid,
    scan,
)
from rviz_view import MadeUpView, draw, drawer, only
from sensor_msgs.msg import PointField
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.options import rainbow

from bullet_sim.pose import Pose


def test_a_scan_is_what_the_beams_have_hit():
    parts, statuses = draw("LaserScan", scan(), Pose((1.0, 0.0, 0.5)),
                           **{"Color Transformer": "FlatColor", "Color": "255; 128; 0"})
    part = only(parts)
    positions = part.arrays["position"]
    assert positions.shape == (HITS, 3) and part.pose.position == (1.0, 0.0, 0.5)
    assert positions[0] == pytest.approx([-2, 0, 0], abs=1e-6)  # the first beam: backwards
    assert np.abs(positions[:, :2]).max(axis=1) == pytest.approx(np.full(HITS, 2.0), abs=1e-5)
    assert part.arrays["colour"][0].tolist() == [255, 128, 0, 255]
    assert statuses == {"Points": ("ok", "Showing 300 points")}


def test_what_is_no_range_is_no_point():
    message = scan()
    message.ranges = [math.nan, math.inf, -1.0, 0.05, 11.0, 1.0]
    assert only(draw("LaserScan", message)[0]).arrays["position"].shape == (1, 3)
    message.ranges = []
    assert only(draw("LaserScan", message)[0]).arrays["position"].shape == (0, 3)
    message.angle_increment = math.nan
    with pytest.raises(Problem, match="angles"):
        draw("LaserScan", message)


def test_a_scan_is_coloured_by_its_intensities_from_red_to_magenta():
    message = scan()
    message.intensities = list(range(len(message.ranges)))
    colours = only(draw("LaserScan", message)[0]).arrays["colour"]
    assert colours[0].tolist() == [255, 0, 0, 255] and colours[-1].tolist() == [255, 0, 255, 255]
    assert rainbow(np.array([0.5])).tolist() == [[0, 255, 127]]
    grey = only(draw("LaserScan", message, **{"Use rainbow": False})[0]).arrays["colour"]
    assert grey[[0, -1], 0].tolist() == [0, 255]


def test_a_cloud_is_thinned_to_what_the_page_takes():
    parts, statuses = draw("PointCloud2", cloud(10_000), view=MadeUpView(most_points=1000),
                           **{"Color Transformer": "AxisColor", "Axis": "X"})
    positions = only(parts).arrays["position"]
    assert positions.shape == (1000, 3)
    assert (positions[:, 0].min(), positions[:, 0].max()) == pytest.approx((-4, -2), abs=0.05)
    assert statuses == {"Points": ("ok", "showing 1000 of 10000 points")}


def packed(rows, **changes):
    """Two padded rows of two points with a colour: x, y, z, rgb in a float."""
    message = cloud(4)
    message.width, message.height, message.point_step, message.row_step = 2, 2, 16, 40
    message.fields.append(PointField("rgb", 12, PointField.FLOAT32, 1))
    table = np.zeros((2, 40), np.uint8)
    table[:, :32] = np.array(rows, "<f4").view(np.uint8).reshape(2, 32)
    message.data = table.tobytes()
    for name, value in changes.items():
        setattr(message, name, value)
    return message


RED = np.array([0xFF0000], "<u4").view("<f4")[0]
ROWS = [(1, 2, 3, RED), (4, 5, 6, RED), (7, 8, 9, RED), (np.nan, 0, 0, RED)]


def test_colours_of_a_cloud_are_unpacked_and_what_is_no_number_is_left_out():
    part = only(draw("PointCloud2", packed(ROWS))[0])
    assert part.arrays["position"].tolist() == [[1, 2, 3], [4, 5, 6], [7, 8, 9]]
    assert part.arrays["colour"].tolist() == [[255, 0, 0, 255]] * 3


def test_a_cloud_without_colours_is_coloured_by_intensity_or_else_by_height():
    message = cloud(2)
    message.data = np.array([(0, 0, 2), (1, 0, 1)], "<f4").tobytes()
    assert only(draw("PointCloud2", message)[0]).arrays["colour"][:, 2].tolist() == [255, 0]
    message.fields[0].name, message.fields[2].name = "intensity", "x"
    message.fields.append(PointField("z", 4, PointField.FLOAT32, 1))
    assert only(draw("PointCloud2", message)[0]).arrays["colour"][:, 2].tolist() == [0, 255]


@pytest.mark.parametrize("fixed, seen", [(True, [(255, 0, 255), (255, 0, 0)]),
                                         (False, [(255, 0, 0)] * 2)])
def test_an_axis_colours_in_the_fixed_frame(fixed, seen):
    message = cloud(2)
    message.data = np.array([(0, 0, 1), (0, 1, 1)], "<f4").tobytes()  # a camera: z ahead, y down
    camera = Pose.from_xyz_rpy((0.0, 0.0, 1.0), (-math.pi / 2, 0.0, -math.pi / 2))
    colours = only(draw("PointCloud2", message, camera, **{
        "Color Transformer": "AxisColor", "Use Fixed Frame": fixed})[0]).arrays["colour"]
    assert [tuple(one[:3]) for one in colours.tolist()] == seen


@pytest.mark.parametrize("changes, said", [
    ({"data": b""}, "does not match width"), ({"fields": []}, "no field x")])
def test_clouds_whose_sizes_do_not_fit_are_refused(changes, said):
    with pytest.raises(Problem, match=said):
        draw("PointCloud2", packed(ROWS, **changes))


def test_a_map_is_its_cells_and_an_update_changes_some():
    made = drawer("Map", **{"Color Scheme": "costmap", "Draw Behind": True})
    made.take(grid(), None, 0.0)
    part = only(made.draw(MadeUpView()))
    assert (part.fields["width"], part.fields["height"]) == (80, 60)
    assert part.fields["size"] == pytest.approx([8.0, 6.0])
    assert part.pose.position == (-3.0, -2.5, 0.0) and part.fields["scheme"] == "costmap"
    cells = part.arrays["cells"].reshape(60, 80)
    assert (cells[0, 0], cells[30, 40], cells[5, 70]) == (100, 0, 255)
    update = OccupancyGridUpdate(x=10, y=20, width=2, height=1, data=[50, 60])
    made.take(update, None, 0.0)
    changed = only(made.draw(MadeUpView()))
    assert changed.arrays["cells"].reshape(60, 80)[20, 9:13].tolist() == [0, 50, 60, 0]
    assert changed.key != part.key
    assert only(made.draw(MadeUpView())).key == changed.key
    for hostile in (OccupancyGridUpdate(x=79, y=0, width=2, height=1, data=[1, 1]),
                    OccupancyGridUpdate(x=-1, y=0, width=1, height=1, data=[1]),
                    OccupancyGridUpdate(x=0, y=0, width=2, height=2, data=[1])):
        with pytest.raises(Problem):
            made.take(hostile, None, 0.0)


@pytest.mark.parametrize("field, value, said", [
    ("width", 0, r"zero-sized \(0x60\)"), ("width", 4_000_000_000, "doesn't match width"),
    ("resolution", math.nan, "nans or infs"), ("resolution", -1.0, "resolution of -1"),
])
def test_a_map_of_wrong_sizes_is_refused_and_takes_the_last_one_away(field, value, said):
    made = drawer("Map")
    made.take(grid(), None, 0.0)
    broken = grid()
    setattr(broken.info, field, value)
    with pytest.raises(Problem, match=said):
        made.take(broken, None, 0.0)
    assert made.draw(MadeUpView()) == []


def test_a_huge_map_is_shown_by_every_other_cell():
    message = grid()
    message.info.width, message.info.height = 5000, 2
    message.data = np.arange(10_000, dtype=np.int8)
    parts, statuses = draw("Map", message)
    assert (parts[0].fields["width"], parts[0].fields["height"]) == (2500, 1)
    assert statuses["Size"][1] == "showing one of 2 x 2 cells"
