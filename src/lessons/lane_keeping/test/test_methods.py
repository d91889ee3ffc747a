"""Every method on drawn lanes whose middle is known, and on pictures without a lane."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawn_lane import draw, lane_points
from lane_keeping.binarise import line_mask
from lane_keeping.methods import method_called
from lane_keeping.road_view import road_view
from lane_keeping.settings import METHODS, load_settings

SETTINGS = load_settings(Path(__file__).parents[1] / "config" / "lane_keeping.yaml")
VIEW = road_view(SETTINGS, 640, 480)
SHADE = (((0.3, -1.0), (1.2, -1.0), (1.5, 0.1), (0.3, 0.0)),)
LANES = {
    "straight": {},
    "beside": {"beside": 0.1, "turned": -0.1},
    "left bend": {"curvature": 1 / 1.4},
    "right bend": {"curvature": -1 / 1.4, "beside": -0.05},
    "shade": {"shade": SHADE},
    "on a zebra": {"zebra": (0.4, 1.2)},
    "before a zebra": {"zebra": (0.8, 1.6), "beside": 0.04},
}
# Columns are poor where a line leads along them.
TOLERANCE_PX = {"column_scan": {"left bend": 12, "right bend": 12}}


@pytest.fixture(scope="module")
def masks():
    return {name: line_mask(draw(SETTINGS, noise=0.01, **lane), SETTINGS)
            for name, lane in LANES.items()}


def centre_column(row, beside=0.0, turned=0.0, curvature=0.0, **_drawn):
    """Where the lane's middle is in a row of the region, in px."""
    ground = lane_points(beside, turned, curvature, begin=0.2, end=1.2)
    columns, rows = VIEW.to_pixels(ground).T
    order = rows.argsort()
    return np.interp(row, rows[order], columns[order])


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("lane", LANES)
def test_the_middle_is_found_where_it_is(masks, name, lane):
    plan = method_called(name)(masks[lane], VIEW, SETTINGS)
    wanted = centre_column(plan.target[1], **LANES[lane])
    assert plan.target[0] == pytest.approx(wanted, abs=TOLERANCE_PX.get(name, {}).get(lane, 6))


@pytest.mark.parametrize("name", METHODS)
def test_straights_are_quick_and_bends_are_slow(masks, name):
    find = method_called(name)
    assert find(masks["straight"], VIEW, SETTINGS).speed == SETTINGS.straight_speed
    left, right = (find(masks[bend], VIEW, SETTINGS) for bend in ("left bend", "right bend"))
    assert left.speed == right.speed == SETTINGS.bend_speed
    assert left.turn > 0.2 and right.turn < -0.2


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("side", [1, -1])
def test_one_line_is_enough(name, side):
    mask = line_mask(draw(SETTINGS, sides=(side,)), SETTINGS)
    plan = method_called(name)(mask, VIEW, SETTINGS)
    assert (plan.lane.left is None, plan.lane.right is None) == (side == -1, side == 1)
    assert plan.target[0] == pytest.approx(320, abs=10)


@pytest.mark.parametrize("name", METHODS)
def test_no_line_is_no_plan(name):
    find = method_called(name)
    assert find(np.zeros((240, 640), np.uint8), VIEW, SETTINGS) is None
    specks = np.zeros((240, 640), np.uint8)
    specks[100:106, 300:306] = 255
    assert find(specks, VIEW, SETTINGS) is None


@pytest.mark.parametrize("name", METHODS)
def test_random_masks_do_not_trip_it(name):
    random, find = np.random.default_rng(1), method_called(name)
    for density in (0.001, 0.05, 0.5):
        mask = np.where(random.random((240, 640)) < density, 255, 0).astype(np.uint8)
        plan = find(mask, VIEW, SETTINGS)
        assert plan is None or np.isfinite([plan.speed, plan.turn, plan.error]).all()


def test_other_sizes_of_pictures():
    small = road_view(SETTINGS, 320, 240)
    settings = replace(SETTINGS, block_px=31, opening_px=3, margin_px=40, min_pixels=15)
    mask = line_mask(draw(SETTINGS, beside=0.1, size=(320, 240)), settings)
    plan = method_called("sliding_windows")(mask, small, settings)
    assert small.to_ground(np.array(plan.target))[1] == pytest.approx(-0.1, abs=0.01)


def test_an_unknown_method_lists_the_known():
    with pytest.raises(ValueError, match="no method 'magic'; known: sliding_windows, "):
        method_called("magic")
