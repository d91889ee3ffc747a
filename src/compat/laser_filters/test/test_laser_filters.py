"""The filters of a chain, on small scans, and what is said of a chain that cannot be used."""

import numpy as np
import pytest
from laser_filters.chain import BadChain, Chain
from laser_filters.scan import Scan

NAN = np.nan


def scan(ranges, intensities=(), angle_min=0.0, angle_increment=0.1, **more):
    return Scan(np.array(ranges, float), np.array(intensities, float), angle_min,
                angle_increment, 0.1, 10.0, **more)


def points(_frame, one):
    """The laser is where the frame is."""
    return one.ranges[:, None] * np.column_stack(
        (np.cos(one.angles), np.sin(one.angles), np.zeros(len(one.ranges))))


def through(kind, params, *scans):
    chain = Chain([{"name": "it", "type": f"laser_filters/{kind}", "params": params}], "chain")
    return [chain.filtered(one, points) for one in scans][-1]


@pytest.mark.parametrize("kind, params, ranges, expected", [
    ("LaserScanRangeFilter", {"lower_threshold": 1, "upper_threshold": 5.0},
     [0.5, 1.0, 2, 5, 6], [NAN, NAN, 2, NAN, NAN]),
    ("LaserScanRangeFilter", {"use_message_range_limits": True, "upper_replacement_value": "inf"},
     [0.05, 1, 10, 11], [NAN, 1, np.inf, np.inf]),
    ("LaserScanAngularBoundsFilterInPlace", {"lower_angle": 0.05, "upper_angle": 0.25},
     [1, 2, 3, 4], [1, 11, 11, 4]),
    ("LaserScanFootprintFilter", {"inscribed_radius": 0.5}, [0.4, 0.6, 0.5, NAN],
     [NAN, 0.6, NAN, NAN]),
    ("LaserScanBoxFilter", {"box_frame": "a", "min_x": 0, "max_x": 2, "min_y": -1, "max_y": 1,
                            "min_z": -1, "max_z": 1}, [1, 3, NAN], [NAN, 3, NAN]),
    ("LaserScanBoxFilter", {"box_frame": "a", "min_x": 0, "max_x": 2, "min_y": -1, "max_y": 1,
                            "min_z": -1, "max_z": 1, "invert": True}, [1, 3], [1, NAN]),
    ("LaserScanPolygonFilter", {"polygon": [[0, -1], [2, -1], [2, 1], [0, 1]]}, [1, 3],
     [NAN, 3]),
    ("InterpolationFilter", {}, [2, NAN, 0.0, 4, 20], [2, 3, 3, 4, (4 + 9.99) / 2]),
    ("InterpolationFilter", {}, [np.inf, 4], [(9.99 + 4) / 2, 4]),
    ("LaserScanMaskFilter", {"masks": {"laser": [1, 9]}}, [1, 2, 3], [1, NAN, 3]),
    ("LaserScanSpeckleFilter", {"max_range": 5, "filter_window": 3},
     [1, 1.05, 1.02, 3, 2, 2, 7], [1, 1.05, 1.02, NAN, NAN, NAN, 7])])
def test_what_is_left_of_the_ranges(kind, params, ranges, expected):
    found = through(kind, params, scan(ranges, frame="laser"))
    np.testing.assert_allclose(found.ranges, expected)


def test_intensities_choose_beams():
    bright = scan([1, 2, 3], [10, 500, 9000])
    params = {"lower_threshold": 100, "upper_threshold": 1000}
    np.testing.assert_equal(through("LaserScanIntensityFilter", params, bright).ranges,
                            [NAN, 2, NAN])
    inverted = through("LaserScanIntensityFilter", {**params, "invert": True,
                                                    "filter_override_intensity": True}, bright)
    np.testing.assert_equal(inverted.ranges, [1, NAN, 3])
    np.testing.assert_equal(inverted.intensities, [10, 0, 9000])


def test_bounds_shorten_the_scan():
    found = through("LaserScanAngularBoundsFilter", {"lower_angle": 0.05, "upper_angle": 0.25},
                    scan([1, 2, 3, 4], [5, 6, 7, 8], time_increment=0.01))
    assert found.ranges.tolist() == [2, 3] and found.intensities.tolist() == [6, 7]
    assert found.angle_min == pytest.approx(0.1) and found.delay == pytest.approx(0.01)


def test_a_point_between_an_edge_and_the_wall_behind_is_a_shadow():
    """A post 1 m away before a wall at 4 m; one beam hit both and says 2.5 m."""
    ranges = [4, 4, 1, 1, 2.5, 4, 4]
    params = {"min_angle": 10, "max_angle": 170, "window": 1, "neighbors": 1}
    found = through("ScanShadowsFilter", params, scan(ranges, angle_increment=0.0087)).ranges
    assert np.isnan(found[4]) and found[2:4].tolist() == [1, 1] and found[6] == 4
    wall = scan(1.0 / np.cos(np.arange(-5, 6) * 0.1), angle_min=-0.5)
    np.testing.assert_equal(through("ScanShadowsFilter", params, wall).ranges, wall.ranges)


@pytest.mark.parametrize("kind, expected", [("Median", [2, 3]), ("Mean", [3, 7 / 3])])
def test_the_last_scans_together(kind, expected):
    stage = {"name": "m", "type": f"filters/MultiChannel{kind}FilterFloat",
             "params": {"number_of_observations": 3}}
    scans = [scan(ranges) for ranges in ([99, 99], [2, 3], [1, 4], [6, 0])]
    for kind_of_chain, params in (("LaserArrayFilter", {"range_filter_chain": [stage]}),
                                  ("LaserMedianFilter", {"internal_filter": [stage]})):
        found = through(kind_of_chain, params, *scans)
        np.testing.assert_allclose(found.ranges, expected)
    assert len(through("LaserArrayFilter", {"range_filter_chain": [stage]}, *scans,
                       scan([5])).ranges) == 1


def test_filters_follow_one_another():
    chain = Chain([{"name": "near", "type": "LaserScanRangeFilter",
                    "params": {"lower_threshold": 1.0}},
                   {"name": "fill", "type": "laser_filters/InterpolationFilter"}], "chain")
    np.testing.assert_allclose(chain.filtered(scan([2, 0.5, 4]), points).ranges, [2, 3, 4])


@pytest.mark.parametrize("entries, said", [
    ({"a": 1}, "chain has to be a list"),
    (["x"], "chain[0] has to be an entry with name, type and params"),
    ([{"name": "s", "type": "laser_filters/ScanShadowFilter"}],
     "chain[0] (s): there is no filter laser_filters/ScanShadowFilter (did you mean "
     "ScanShadowsFilter?); there are InterpolationFilter, LaserArrayFilter, "),
    ([{"name": "s", "type": "laser_filters/ScanShadowsFilter", "params": {"min_angle": 1.0}}],
     "chain[0] (s): ScanShadowsFilter needs max_angle, window"),
    ([{"name": "r", "type": "LaserScanRangeFilter", "params": {"lower_threshold": "near"}}],
     "chain[0] (r): lower_threshold is 'near'; it has to be of type float"),
    ([{"name": "p", "type": "LaserScanPolygonFilter", "params": {"polygon": [1, 2]}}],
     "chain[0] (p): polygon has to be a list of three or more corners"),
    ([{"name": "m", "type": "LaserScanMaskFilter", "params": {"masks": {"a": 3}}}],
     "chain[0] (m): masks: a has to be a list"),
    ([{"name": "k", "type": "LaserScanSpeckleFilter", "params": {"filter_type": 1}}],
     "chain[0] (k): filter_type is 1; here it can only be 0"),
    ([{"name": "k", "type": "LaserScanSpeckleFilter", "params": {"filter_window": 0}}],
     "chain[0] (k): filter_window is 0; it has to be 1 or more"),
    ([{"name": "m", "type": "LaserMedianFilter", "params": {"internal_filter": {
        "type": "MultiChannelMedianFilterFloat", "params": {}}}}],
     "chain[0] (m): internal_filter[0]: number_of_observations is None")])
def test_one_line_says_what_is_wrong_with_a_chain(entries, said):
    with pytest.raises(BadChain) as caught:
        Chain(entries, "chain")
    assert str(caught.value).startswith(said) and "\n" not in str(caught.value)


def test_a_parameter_that_does_not_exist_is_named():
    chain = Chain([{"name": "r", "type": "LaserScanRangeFilter",
                    "params": {"lower_treshold": 1.0}}], "chain")
    assert chain.ignored == ["chain[0] (r): LaserScanRangeFilter knows no parameter "
                             "lower_treshold (did you mean lower_threshold?)"]
