"""The laser's models against their own formulas, and the field of distances that they use."""

from dataclasses import replace

import numpy as np
import pytest
from defaults import of
from house import robust

from nav_algorithms import likelihood_field
from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.sensor_models import (
    BEAM,
    FIELD,
    FIELD_PROB,
    LaserModel,
    Scan,
    SensorSettings,
    _value_at,
)

# A wall 1 cell thick at x = 2.0 to 2.05 m in a free room; columns beyond it are unknown.
CELLS = np.zeros((40, 60), np.int8)
CELLS[:, 40], CELLS[:, 41:] = 100, -1
GRID = OccupancyGrid(CELLS, 0.05, (0.0, 0.0))
SETTINGS = of(SensorSettings, laser_max_beams=100, laser_z_hit=0.7, laser_z_short=0.3,
              laser_z_max=0.2, laser_z_rand=0.1, laser_lambda_short=0.4)
PARTICLES = np.array([[1.025, 1.025, 0.0]])
AHEAD = np.zeros(3)


def logs(model, ranges, angles=None, laser=AHEAD, particles=PARTICLES, converged=False, **changes):
    ranges = np.array(ranges, float)
    scan = Scan(ranges, np.zeros(ranges.size) if angles is None else np.array(angles), laser, 3.5)
    settings = replace(SETTINGS, laser_model_type=model, **changes)
    return LaserModel(GRID, settings).compare(particles, scan, converged)


def p_of(distance):
    return 0.7 * np.exp(-distance**2 / (2 * 0.2**2)) + 0.1 / 3.5


@pytest.mark.parametrize("measured, distance", [(1.0, 0.0), (0.9, 0.1), (0.6, 0.4), (1.1, 0.1)])
def test_a_beam_in_the_field_counts_by_its_end_s_distance_from_the_wall(measured, distance):
    assert logs(FIELD, [measured]).logs[0] == pytest.approx(np.log(1 + p_of(distance)**3))
    assert logs(FIELD_PROB, [measured]).logs[0] == pytest.approx(np.log(p_of(distance)))


def test_beams_add_up_cubed_or_multiply():
    assert logs(FIELD, [1.0, 0.9]).logs[0] == pytest.approx(np.log(1 + p_of(0)**3 + p_of(0.1)**3))
    assert logs(FIELD_PROB, [1.0, 0.9]).logs[0] == pytest.approx(np.log(p_of(0) * p_of(0.1)))


@pytest.mark.parametrize("model", [FIELD, FIELD_PROB])
@pytest.mark.parametrize("nothing", [3.5, 9.0, np.inf, np.nan])
def test_the_field_takes_no_notice_of_beams_without_an_end(model, nothing):
    assert logs(model, [1.0, nothing]).logs[0] == logs(model, [1.0]).logs[0]
    assert logs(model, [nothing]).logs[0] == 0.0
    assert logs(model, [nothing]).parts[0] == 1.0


@pytest.mark.parametrize("model, expected", [(FIELD, np.log(1 + p_of(0.5)**3)),
                                             (FIELD_PROB, np.log(p_of(0.5)))])
def test_off_the_map_and_far_from_all_is_the_largest_distance(model, expected):
    for where in (3.0, 0.3):
        angle = np.pi if where == 3.0 else 0.0
        found = logs(model, [where], [angle], laser_likelihood_max_dist=0.5)
        assert found.logs[0] == pytest.approx(expected)


@pytest.mark.parametrize("thickness, measured, distance", [
    (1.0, 1.0, 0.0), (1.0, 1.05, 0.05), (1.0, 1.2, 0.2),
    (0.35, 1.05, 0.05), (0.25, 1.05, 0.1),
    (0.15, 1.0, 0.0), (0.15, 1.05, 0.1), (0.15, 1.1, 0.0), (0.15, 1.15, 0.05)])
def test_behind_a_wall_s_surface_beams_are_as_wrong_and_within_thin_walls_twice(
        thickness, measured, distance):
    cells = np.zeros_like(CELLS)
    cells[:, 40:40 + round(thickness / 0.05)] = 100
    scan = Scan(np.array([measured]), np.zeros(1), AHEAD, 3.5)
    grid = OccupancyGrid(cells, 0.05, (0, 0))
    found = LaserModel(grid, replace(SETTINGS, **robust(SensorSettings))).compare(PARTICLES, scan)
    assert found.logs[0] == pytest.approx(np.log(1 + p_of(distance)**3))
    by_default = LaserModel(grid, SETTINGS).compare(PARTICLES, scan).logs[0]
    expected = 0.05 if (thickness, measured) == (0.15, 1.15) else 0.0
    assert by_default == pytest.approx(np.log(1 + p_of(expected)**3))


def test_beyond_the_border_nothing_is_read():
    table = np.vstack((np.arange(12.0).reshape(3, 4), np.full(4, np.nan)))[:3]
    assert _value_at(table, 1.0, 9.0) == 9.5
    assert _value_at(table, 9.0, 9.0) == 11.0


def test_between_the_cells_centres_beams_count_in_between():
    beside = np.array([[1.025, 1.0, 0.0], [1.025, 1.01, 0.0]])  # the wall is alike there
    for model, factor in ((FIELD, np.log(1 + (p_of(0.0)**3 + p_of(0.05)**3) / 2)),
                          (FIELD_PROB, (np.log(p_of(0.0)) + np.log(p_of(0.05))) / 2)):
        assert logs(model, [0.975]).logs[0] == pytest.approx(factor)
        assert logs(model, [0.975], particles=beside).logs == pytest.approx([factor] * 2)


@pytest.mark.parametrize("measured, probability", [
    (0.995, 0.7 * np.exp(-0.005) + 0.1 / 3.5), (1.175, 0.7 * np.exp(-0.5) + 0.1 / 3.5),
    (0.575, 0.7 * np.exp(-2.0) + 0.3 * 0.4 * np.exp(-0.4 * 0.575) + 0.1 / 3.5),
    (3.5, 0.7 * np.exp(-2.525**2 / 0.08) + 0.2), (np.inf, 0.7 * np.exp(-2.525**2 / 0.08) + 0.2)])
def test_the_beam_model_adds_its_four_parts(measured, probability):
    found = logs(BEAM, [measured])
    assert found.logs[0] == pytest.approx(np.log(1 + probability**3))


def test_the_beam_model_s_rays_end_at_the_map_s_edge_and_in_the_unknown():
    assert logs(BEAM, [1.025], [np.pi]).parts[0] == pytest.approx(1.0)
    unknown = np.array([[2.5, 1.0, 0.0], [9.0, 9.0, 0.0]])
    found = logs(BEAM, [0.0001], particles=unknown).logs
    assert found == pytest.approx(np.log(1 + p_of(0)**3), rel=1e-3)


@pytest.mark.parametrize("model", [BEAM, FIELD, FIELD_PROB])
def test_the_laser_s_place_on_the_robot_counts(model):
    turned = np.array([0.2, 0.1, np.pi / 2])
    found = logs(model, [0.8], [-np.pi / 2], laser=turned).logs
    assert found == pytest.approx(logs(model, [1.0]).logs, rel=0.02)


@pytest.mark.parametrize("model, beams, used", [
    (FIELD, 1, [0, 9]), (FIELD, 4, [0, 3, 6, 9]), (FIELD, 5, [0, 2, 4, 6, 8]),
    (FIELD_PROB, 5, [0, 2, 4, 6, 8]), (FIELD_PROB, 4, [0, 3, 6, 9])])
def test_beams_are_left_out_evenly_as_upstream_does(model, beams, used):
    ranges = np.linspace(0.5, 1.4, 10)
    assert logs(model, ranges, laser_max_beams=beams).logs == pytest.approx(
        logs(model, ranges[used]).logs)


def test_beams_that_few_particles_explain_are_skipped_once_converged():
    crowd = np.repeat(PARTICLES, 10, axis=0)
    scan = {"ranges": [1.0, 1.0, 0.3], "particles": crowd, "do_beamskip": True}
    whole = logs(FIELD_PROB, [1.0, 1.0, 0.3]).logs[0]
    assert logs(FIELD_PROB, **scan).logs[0] == pytest.approx(whole)
    assert logs(FIELD_PROB, converged=True, **scan).logs[0] == pytest.approx(2 * np.log(p_of(0)))
    assert logs(FIELD_PROB, converged=True, beam_skip_error_threshold=0.3,
                **scan).logs[0] == pytest.approx(whole)
    assert logs(FIELD_PROB, converged=True, beam_skip_distance=0.75,
                **scan).logs[0] == pytest.approx(whole)
    crowd[:4, 0] = 1.725  # 4 of 10 explain the third beam, and no longer the first two
    assert logs(FIELD_PROB, converged=True, beam_skip_threshold=0.45,
                **scan).logs[-1] == pytest.approx(2 * np.log(p_of(0)))


@pytest.mark.parametrize("seed, share", [(0, 0.01), (1, 0.1), (2, 0.5), (3, 0.002)])
def test_distances_are_those_of_the_nearest_occupied_cell(seed, share):
    occupied = (np.random.default_rng(seed).random((37, 61)) < share).astype(np.uint8)
    occupied[5, 7] = 1
    cells = np.argwhere(np.ones_like(occupied))
    walls = np.argwhere(occupied)
    nearest = np.sqrt(((cells[:, None] - walls[None]) ** 2).sum(-1).min(1)).reshape(37, 61)
    assert likelihood_field.distances(occupied) == pytest.approx(nearest, abs=1e-12)


def test_nothing_occupied_is_infinitely_far():
    assert np.isinf(likelihood_field.distances(np.zeros((4, 3), np.uint8))).all()


def test_one_cell():
    assert likelihood_field.distances(np.ones((1, 1), np.uint8)).tolist() == [[0.0]]
