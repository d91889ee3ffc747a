"""SLAM on made-up drives whose truth is known."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from defaults import of
from slam_world import CELL, ORIGIN, RANGE_MAX, RING, RecordedDrive, drive, trajectory_error, walls

from nav_algorithms import likelihood_field
from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN
from nav_algorithms.particle_slam import ParticleSlam, SlamSettings

SETTINGS = of(SlamSettings, particles=30, maxUrange=3.0, maxRange=RANGE_MAX - 0.01, minimumScore=50,
                        xmin=-2, ymin=-2, xmax=16, ymax=10, linearUpdate=0.5, angularUpdate=0.2)
FIRST_CORRIDOR = RING[:2]


@pytest.fixture(scope="module")
def short():
    return drive(FIRST_CORRIDOR, 0.1, seed=7)


@pytest.mark.parametrize("seed", [1, 2, 4])
def test_a_loop_of_40_m_closes_in_spite_of_bad_odometry(seed):
    loop = drive(RING, 0.1, seed)
    slam = ParticleSlam(SETTINGS, seed)
    used = loop.run(slam)
    _, path = slam.trajectory()
    assert trajectory_error(loop.odometry[used], loop.truth[used]) > 0.3
    assert trajectory_error(path, loop.truth[used]) < 0.08
    # Back in the first corridor it is where it was, as far as the walls tell.
    assert np.hypot(*(path[-1] - loop.truth[used][-1])[:2]) < 0.1


def test_good_odometry_is_trusted_and_a_slip_is_seen_all_the_same():
    good = drive(FIRST_CORRIDOR, 0.1, seed=3, along=0.0, turning=0.0)
    slipped = good.odometry.copy()
    slipped[60:, :2] += (0.05, -0.03)
    slam = ParticleSlam(SETTINGS, 0)
    used = RecordedDrive(good.truth, slipped, good.scans).run(slam)
    off = np.hypot(*(slam.trajectory()[1] - good.truth[used])[:, :2].T)
    assert off[np.array(used) < 60].max() < 0.04
    assert off[-1] < 0.03


def test_the_map_is_that_of_the_walls():
    room = drive(FIRST_CORRIDOR, 0.1, seed=4, along=0.005, turning=np.radians(0.3))
    slam = ParticleSlam(SETTINGS, 0)
    room.run(slam)
    grid = slam.grid()
    points = grid.centres_of(np.argwhere(grid.cells == OCCUPIED))
    world = np.floor((points - ORIGIN) / CELL).astype(int)
    off = likelihood_field.distances(walls())[world[:, 1], world[:, 0]] * CELL
    assert len(points) > 300
    assert (off <= 2 ** 0.5 * SETTINGS.delta).mean() > 0.97
    middle = grid.cells_of((6.0, 1.0))
    assert grid.cells[tuple(middle)] == FREE
    assert grid.cells[tuple(grid.cells_of((7.0, 4.0)))] == UNKNOWN


def test_the_same_seed_gives_the_same_bits_and_another_gives_others(short):
    results = []
    for seed in (0, 0, 1):
        slam = ParticleSlam(SETTINGS, seed)
        short.run(slam)
        results.append((slam.grid().cells.tobytes(), slam.trajectory()[1].tobytes()))
    assert results[0] == results[1]
    assert results[0][1] != results[2][1]


@pytest.mark.parametrize("changed, used", [
    ({"linearUpdate": 1.0, "angularUpdate": 9.0}, 12),
    ({"linearUpdate": 3.0, "angularUpdate": 9.0}, 4),
    ({"linearUpdate": 99.0, "angularUpdate": 9.0, "temporalUpdate": 3.9}, 6)])
def test_scans_are_used_after_way_turn_or_time(short, changed, used):
    slam = ParticleSlam(replace(SETTINGS, particles=1, **changed))
    assert len(short.run(slam)) == pytest.approx(used, abs=1)


def test_the_search_goes_to_two_and_a_half_deviations_in_five_steps_at_most():
    slam = ParticleSlam(replace(SETTINGS, particles=1, delta=0.1, lstep=0.05, astep=0.02))
    slam._step.covariance = np.diag([0.054, 0.022, 9.0])**2  # 2.7 steps, 1.1 and many
    halves, sizes = slam._search_grid()
    assert halves.tolist() == [3, 1, 5]
    assert sizes == pytest.approx([0.5, 0.5, 0.02])
    wanted = np.array([0.54, 0.22, 9.0])**-2  # in cells and rad
    assert slam._informations()[0] == pytest.approx(np.diag(wanted), abs=1e-9)


def test_what_the_odometry_was_off_is_learnt_in_the_robot_s_frame_in_m():
    slam = ParticleSlam(replace(SETTINGS, particles=2, delta=0.1))
    slam._poses[:, 2] = np.pi / 2
    told = []
    slam._step.learn = lambda *what: told.extend(what)
    errors = np.array([[1.0, 2.0, 0.03], [3.0, 2.0, 0.01]])  # on the map, cells
    slam._learn_odometry(errors, np.tile(np.diag([2.0, 4.0, 5.0]), (2, 1, 1)))
    assert told[0] == pytest.approx([0.2, -0.2, 0.02])
    assert told[1] == pytest.approx(np.diag([0.1 / 4, 0.1 / 2, 1 / 5])**2)


def test_weights_that_add_up_to_a_hair_less_than_1_choose_the_last_particle_last():
    slam = ParticleSlam(replace(SETTINGS, particles=5, resampleThreshold=1.0))
    slam._weights = lambda: np.array([0.1] * 4 + [0.6]) * (1.0 - 2.0**-40)
    slam._poses[:, 0] = np.arange(5)
    assert np.cumsum(slam._weights())[-1] < 1.0
    slam._random = SimpleNamespace(random=lambda: 1.0 - 2.0**-53)
    slam._resample()
    assert slam._poses[-1, 0] == 4.0


def test_turning_alone_is_reason_enough():
    slam = ParticleSlam(replace(SETTINGS, particles=2))
    angles, ranges = np.linspace(-3, 3, 90), np.full(90, 2.0)
    used = [slam.add(0.1 * i, (0, 0, 0.11 * i), ranges, angles, np.zeros(3)) for i in range(5)]
    assert used == [True, False, True, False, True]


def test_ranges_beyond_maxurange_only_clear_and_beyond_maxrange_say_nothing():
    slam = ParticleSlam(replace(SETTINGS, particles=2, maxUrange=2.0, maxRange=3.0))
    angles = np.array([0.0, np.pi / 2, np.pi, -np.pi / 2, 0.7])
    slam.add(0.0, (3, 3, 0), np.array([1.52, 2.5, 3.2, np.inf, np.nan]), angles, np.zeros(3))
    grid = slam.grid()
    at = {name: grid.cells[tuple(grid.cells_of(point))] for name, point in {
        "hit": (4.52, 3.01), "before": (4.0, 3.01), "clear": (3.01, 4.9), "end": (3.01, 5.4),
        "beyond": (1.0, 3.01), "inf": (3.01, 2.0)}.items()}
    assert at == {"hit": OCCUPIED, "before": FREE, "clear": FREE, "end": UNKNOWN,
                  "beyond": UNKNOWN, "inf": UNKNOWN}


def test_a_laser_mounted_elsewhere_is_reckoned_with():
    slam = ParticleSlam(replace(SETTINGS, particles=1))
    slam.add(0.0, (3, 3, np.pi / 2), np.array([1.0]), np.array([0.0]),
             np.array([0.5, 0.2, -np.pi / 2]))
    grid = slam.grid()
    row, column = np.argwhere(grid.cells == OCCUPIED)[0]
    assert grid.centres_of((row, column)) == pytest.approx((3 - 0.2 + 1.0, 3.5), abs=0.05)


def test_maps_grow_where_the_robot_leaves_them():
    slam = ParticleSlam(replace(SETTINGS, xmin=-0.5, ymin=-0.5, xmax=0.5, ymax=0.5, particles=3))
    angles, ranges = np.linspace(-3, 3, 90), np.full(90, 2.0)
    for i in range(4):
        slam.add(i, (-3.0 * i, 2.0 * i, 0), ranges, angles, np.zeros(3))
    grid = slam.grid()
    assert grid.contains(grid.cells_of(((-10.9, 6.0), (1.9, 0.0)))).all()


def test_without_a_match_the_odometry_is_followed():
    slam = ParticleSlam(replace(SETTINGS, minimumScore=1e6))
    angles, ranges = np.linspace(-3, 3, 90), np.full(90, 2.0)
    for i in range(6):
        slam.add(i, (1.0 * i, 0, 0), ranges, angles, np.zeros(3))
    assert slam.pose == pytest.approx((5, 0, 0), abs=1.0)
    assert np.ptp(slam.map_to_odom[:2]) < 1.0


def test_scans_that_see_nothing_do_no_harm():
    slam = ParticleSlam(replace(SETTINGS, particles=5))
    for i in range(5):
        slam.add(i, (0.6 * i, 0, 0), np.full(90, np.inf), np.linspace(-3, 3, 90), np.zeros(3))
    assert slam.pose == pytest.approx((2.4, 0, 0), abs=0.6)
    assert (slam.grid().cells == UNKNOWN).all()
    assert slam.entropy == pytest.approx(np.log(5), abs=0.01)


@pytest.mark.parametrize("lost", [
    {"ranges": np.array([1.52, np.inf])}, {"angles": np.array([0.0, np.nan])}])
def test_a_beam_without_an_end_is_passed_over_whatever_the_sensor_calls_its_reach(lost):
    slam = ParticleSlam(replace(SETTINGS, particles=2, maxRange=np.inf, maxUrange=np.inf))
    beams = {"ranges": np.array([1.52, 1.0]), "angles": np.array([0.0, 1.5])} | lost
    assert slam.add(0.0, (3, 3, 0), laser=np.zeros(3), **beams)
    assert np.argwhere(slam.grid().cells == OCCUPIED).tolist() == [
        slam.grid().cells_of((4.52, 3.01)).tolist()]
