"""From messages to the algorithm, without a master."""

from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import Quaternion, Transform, Vector3
from sensor_msgs.msg import LaserScan

from gmapping.mapper import TABLE, Mapper, ScanError, ranges_of, settings_from
from nav_algorithms.cells import OCCUPIED
from nav_nodes.laser_mount import Mount
from nav_nodes.parameters import ParameterError, load_table

PACKAGE = Path(__file__).parent.parent
DEFAULTS = {entry.name: entry.default for entry in load_table(PACKAGE / TABLE)}
SMALL = {**DEFAULTS, "particles": 3, "xmin": -5.0, "xmax": 5.0, "ymin": -5.0, "ymax": 5.0}


def mount(x, y, z, w):
    return Mount.of(Transform(Vector3(0.1, 0.2, 0.3), Quaternion(x, y, z, w)))


def test_every_parameter_of_upstream_has_upstreams_default():
    # Reference 9.6; -1 stands for "as the scan says" and "as transform_publish_period".
    assert DEFAULTS == {
        "throttle_scans": 1, "base_frame": "base_link", "map_frame": "map", "odom_frame": "odom",
        "transform_publish_period": 0.05, "tf_delay": -1.0, "map_update_interval": 5.0,
        "maxRange": -1.0, "maxUrange": -1.0, "minimumScore": 0.0, "sigma": 0.05, "kernelSize": 1,
        "lstep": 0.05, "astep": 0.05, "iterations": 5, "lsigma": 0.075, "ogain": 3.0, "lskip": 0,
        "srr": 0.1, "srt": 0.2, "str": 0.1, "stt": 0.2, "linearUpdate": 1.0, "angularUpdate": 0.5,
        "temporalUpdate": -1.0, "resampleThreshold": 0.5, "particles": 30, "xmin": -100.0,
        "ymin": -100.0, "xmax": 100.0, "ymax": 100.0, "delta": 0.05, "occ_thresh": 0.25,
        "llsamplerange": 0.01, "llsamplestep": 0.01, "lasamplerange": 0.005,
        "lasamplestep": 0.005, "seed": 0}


def test_ranges_reach_as_far_as_the_sensor_unless_told_otherwise():
    assert settings_from(DEFAULTS, 3.5).maxRange == pytest.approx(3.49)
    assert settings_from(DEFAULTS, 3.5).maxUrange == pytest.approx(3.49)
    told = settings_from({**DEFAULTS, "maxUrange": 2.0, "maxRange": 8.0}, 3.5)
    assert (told.maxUrange, told.maxRange) == (2.0, 8.0)


@pytest.mark.parametrize("changed, said", [
    ({"ymin": 7.0, "ymax": 3.0}, "~ymin is 7"), ({"delta": 0.001}, "4e[+]10 cells"),
    ({"xmax": np.inf}, "inf cells")])
def test_a_map_without_extent_or_with_too_much_is_refused_before_any_scan(changed, said):
    with pytest.raises(ParameterError, match=said):
        Mapper({**DEFAULTS, **changed})


def test_what_is_too_near_counts_as_nothing_there():
    scan = LaserScan(range_min=0.1, range_max=3.5,
                     ranges=[0.05, 1.0, float("inf"), -float("inf"), float("nan")])
    assert ranges_of(scan) == pytest.approx([3.5, 1.0, np.inf, 3.5, np.nan], nan_ok=True)


def test_mounts():
    assert mount(0, 0, 0, 1).pose == pytest.approx((0.1, 0.2, 0.0))
    assert mount(0, 0, np.sin(0.4), np.cos(0.4)).pose[2] == pytest.approx(0.8)
    assert not mount(0, 0, np.sin(0.4), np.cos(0.4)).upside_down
    turned_over = mount(1, 0, 0, 0)
    assert turned_over.upside_down and turned_over.pose[2] == pytest.approx(0.0)
    with pytest.raises(ValueError, match="along the floor"):
        mount(np.sin(0.3), 0, 0, np.cos(0.3))


@pytest.mark.parametrize("upside_down, y", [(False, 1.02), (True, -1.02)])
def test_an_upside_down_laser_turns_the_other_way(upside_down, y):
    scan = LaserScan(angle_min=np.pi / 2, angle_increment=0.1, range_max=3.5, ranges=[1.02])
    mapper = Mapper(SMALL)
    assert mapper.take(scan, np.zeros(3), Mount(np.zeros(3), upside_down))
    grid = mapper.slam.grid()
    assert grid.cells[tuple(grid.cells_of((0.01, y)))] == OCCUPIED


def scan_of(reach, range_max=3.5):
    return LaserScan(angle_increment=0.1, range_max=range_max, ranges=[1.0, reach])


@pytest.mark.parametrize("reach, x, said", [
    (1e6, 0.0, "scan of 1e[+]06 m about [(]0, 0[)] m is left out: it would have 2e[+]15 cells"),
    (3e38, 0.0, "more than 5e[+]07; write a smaller ~maxUrange"),
    (2.0, 1e9, "about [(]1e[+]09, 0[)] m is left out: the map would have 4e[+]12 cells"),
    (2.0, 1e300, "more than 5e[+]08"), (2.0, np.nan, "nan cells")])
def test_a_scan_for_which_no_map_is_large_enough_is_as_if_it_had_not_come(reach, x, said):
    """First, when its range_max must not become the algorithm's, and later."""
    mapper = Mapper(SMALL)
    level, absurd, odometry = Mount(np.zeros(3), False), scan_of(reach, 1e39), np.array([x, 0, 0])
    with pytest.raises(ScanError, match=said):
        mapper.take(absurd, odometry, level)
    assert mapper.take(scan_of(2.0), np.zeros(3), level)
    assert mapper.slam.settings.maxRange == pytest.approx(3.49)
    if x:
        with pytest.raises(ScanError, match=said):
            mapper.take(absurd, odometry, level)
    assert mapper.take(scan_of(2.0), np.array([1.0, 0, 0]), level)
    assert mapper.slam.grid().cells.size < 1e6


def test_the_map_grows_step_by_step_up_to_its_limit(monkeypatch):
    monkeypatch.setattr("gmapping.mapper.LARGEST", 1e5)
    mapper, level = Mapper(SMALL), Mount(np.zeros(3), False)
    for x in (0.0, 3.0, 6.0, 9.0):  # to 16 m x 10 m, 6.4e4 cells
        assert mapper.take(scan_of(2.0), np.array([x, 0, 0]), level)
    with pytest.raises(ScanError, match=r"the map would have 1e\+05 cells"):
        mapper.take(scan_of(2.0), np.array([19.0, 0, 0]), level)
    assert mapper.take(scan_of(2.0), np.array([11.0, 0, 0]), level)


def test_throttle_scans():
    mapper = Mapper({**SMALL, "throttle_scans": 3})
    assert [mapper.is_wanted() for _ in range(7)] == [True, False, False] * 2 + [True]
