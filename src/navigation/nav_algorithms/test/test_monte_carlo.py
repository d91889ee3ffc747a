"""A robot in a made-up flat: kept track of, found, and found again after it was carried away."""

from dataclasses import replace

import numpy as np
import pytest
from defaults import of
from house import ANGLES, LASER, RANGE_MAX, Robot, flat, ring, robust, room

from nav_algorithms import poses
from nav_algorithms.monte_carlo import Localisation, LocalisationSettings, _at
from nav_algorithms.sensor_models import FIELD, FIELD_PROB, Scan, SensorSettings

SETTINGS = of(LocalisationSettings,
    min_particles=500, max_particles=2000, kld_err=0.02, update_min_a=0.2, resample_interval=1,
    odom_alpha1=0.1, odom_alpha2=0.1, odom_alpha3=0.1, odom_alpha4=0.1,
    **robust(LocalisationSettings))
SENSOR = of(SensorSettings, laser_max_beams=180, laser_z_hit=0.5, laser_z_rand=0.5,
                        **robust(SensorSettings))
CLOSE = np.diag([0.02, 0.02, 0.01])
SEEN = Scan(np.full(360, 2.0), ANGLES, LASER, RANGE_MAX)


def localisation(seed=0, model=FIELD, place=None, **changes):
    return Localisation(place or flat(), replace(SETTINGS, **changes),
                        replace(SENSOR, laser_model_type=model), np.random.default_rng(seed))


@pytest.mark.parametrize("seed, model", [(1, FIELD), (2, FIELD), (3, FIELD_PROB)])
def test_a_driving_robot_is_kept_track_of(seed, model):
    robot, found = Robot(seed), localisation(seed, model)
    found.start_at(robot.pose, CLOSE)
    errors = robot.follow(found, 60)[25:]
    assert errors[:, 0].mean() < 0.05
    assert np.degrees(errors[:, 1]).mean() < 2.0
    assert len(found.particles) < 700


@pytest.mark.parametrize("seed", [0, 2])
def test_walls_a_cell_behind_those_of_the_map_push_the_robot_nowhere(seed):
    robot, found = Robot(seed, room(9)), localisation(seed, place=room(10))
    found.start_at(robot.pose, CLOSE)
    assert robot.follow(found, 100)[100:, 0].mean() < 0.025


@pytest.mark.parametrize("seed", [1, 5])
def test_a_crowd_about_the_robot_does_not_have_it_at_a_place_that_looks_alike(seed):
    robot, found = Robot(seed, ring()), localisation(seed, place=ring())
    found.start_at(robot.pose, CLOSE)
    robot.follow(found, 15)
    robot.crowd = 0.55
    errors = robot.follow(found, 15)
    robot.crowd = 0.0
    assert errors[:, 0].max() < 0.2
    assert robot.follow(found, 15)[:, 0].max() < 0.2


def test_the_beam_model_keeps_track_too():
    robot = Robot(4)
    found = Localisation(flat(), SETTINGS, of(SensorSettings, laser_model_type="beam"),
                         np.random.default_rng(0))
    found.start_at(robot.pose, CLOSE)
    assert robot.follow(found, 20)[25:, 0].mean() < 0.07


@pytest.mark.parametrize("seed", [2, 3])
def test_a_robot_anywhere_is_found(seed):
    robot, found = Robot(seed), localisation(seed)
    found.start_anywhere()
    assert len(found.particles) == 2000
    errors = robot.follow(found, 60)
    assert (errors[-25:] < (0.3, 0.2)).all()


@pytest.mark.parametrize("seed", [1, 2])
def test_a_kidnapped_robot_is_found_again(seed):
    robot, found = Robot(seed), localisation(seed)
    found.start_at(robot.pose, CLOSE)
    robot.follow(found, 20)
    assert found.lost == 0.0
    robot.kidnap()
    errors = robot.follow(found, 60)
    assert errors[0, 0] > 0.5
    assert (errors[-25:] < (0.3, 0.2)).all()


def test_without_recovery_a_lost_robot_is_not_looked_for():
    robot, found = Robot(1), localisation(1, recovery_alpha_fast=0.0, recovery_alpha_slow=0.0)
    found.start_at(robot.pose, CLOSE)
    robot.follow(found, 5)
    robot.kidnap()
    assert robot.follow(found, 15)[-1, 0] > 0.5
    assert found.lost == 0.0


def test_by_default_a_lost_robot_is_looked_for_as_upstream_does():
    """By as many random poses as the scans are worse, and then the averages begin anew."""
    off = {name: getattr(of(LocalisationSettings), name) for name in robust(LocalisationSettings)}
    robot, found = Robot(1), localisation(1, resample_interval=2, **off)
    found.start_at(robot.pose, CLOSE)
    robot.follow(found, 20)
    robot.kidnap()
    lost = []
    for _ in range(50):
        robot.drive()
        step = found.add(robot.odometry, robot.scan())
        lost.append(found.lost)
        assert found.lost == 0.0 or not (step.weighed and step.estimated)
    assert max(lost) > 0.0


def test_the_first_scan_counts_though_there_is_one_particle_alone():
    robot = Robot(1)
    found = localisation(min_particles=1, max_particles=1, recovery_alpha_slow=0.001,
                         recovery_alpha_fast=1.0, lost_threshold=0.0, lost_share_max=1.0,
                         lost_forgets=False)
    found.start_at(robot.pose, np.zeros((3, 3)))
    found.add(robot.odometry, robot.scan())
    assert found.lost == 0.0
    found.add(robot.odometry + np.array([0.3, 0.0, 0.0]), replace(SEEN, ranges=SEEN.ranges - 1.9))
    assert found.lost > 0.5


def test_weights_are_as_the_scan_fits_and_add_up_to_1():
    robot, found = Robot(1), localisation(resample_interval=9)
    found.start_at(robot.pose, CLOSE)
    found.particles[:1000] = robot.pose
    found.add(robot.odometry, robot.scan())
    assert np.ptp(found.weights[:1000]) == 0.0 and found.weights[0] > 1.2 / 2000
    assert found.weights.sum() == pytest.approx(1.0)


def test_each_particle_is_drawn_by_its_share_of_the_weights():
    sums = np.cumsum([1.0, 0.0, 1.0, 2.0])
    assert _at(sums, np.array([0.0, 0.2, 0.3, 0.49, 0.51, 0.9, 1.0])).tolist() == [
        0, 0, 2, 2, 3, 3, 3]


def test_the_same_seed_gives_the_same_bits_and_another_gives_others():
    ends = []
    for seed in (0, 0, 1):
        found = localisation(seed)
        found.start_anywhere()
        Robot(5).follow(found, 6)
        ends.append(found.particles.tobytes())
    assert ends[0] == ends[1] != ends[2]


def test_scans_are_weighed_after_way_or_turn_or_when_asked_for():
    found = localisation(update_min_d=0.2, update_min_a=0.5)
    found.start_at((4, 4, 0), CLOSE)
    ways = [(0, 0, 0), (0.19, 0.19, 0.49), (0.21, 0, 0), (0.21, -0.21, 0), (0.21, -0.21, 0.51)]
    assert [found.add(way, SEEN).weighed for way in ways] == [True, False, True, True, True]
    assert not found.add(ways[-1], SEEN).weighed
    found.weigh_next()
    assert found.add(ways[-1], SEEN).weighed


def test_a_second_laser_is_weighed_at_the_same_place():
    found = localisation()
    found.start_at((4, 4, 0), CLOSE)
    assert found.add((0, 0, 0), SEEN, "front").weighed
    assert found.add((0, 0, 0), SEEN, "rear").weighed
    assert not found.add((0, 0, 0), SEEN, "rear").weighed


def test_estimates_come_first_and_then_with_each_resampling():
    found = localisation(resample_interval=3)
    found.start_at((4, 4, 0), CLOSE)
    estimated = [found.add((0.3 * i, 0, 0), SEEN).estimated for i in range(7)]
    assert estimated == [True, False, True, False, False, True, False]


def test_selective_resampling_leaves_even_weights_alone():
    nothing = Scan(np.full(360, np.inf), ANGLES, LASER, RANGE_MAX)
    counts = []
    for selective in (False, True):
        found = localisation(selective_resampling=selective)
        found.start_at((4, 4, 0), CLOSE)
        found.add((0, 0, 0), nothing)
        counts.append(len(found.particles))
    assert counts[0] < counts[1] == 2000


def test_the_start_is_spread_as_asked():
    found = localisation(max_particles=5000)
    found.start_at((1, 2, 1), np.array([[0.25, 0.1, 0], [0.1, 0.16, 0], [0, 0, 0.01]]))
    assert found.particles.mean(axis=0) == pytest.approx((1, 2, 1), abs=0.03)
    assert np.cov(found.particles[:, :2].T) == pytest.approx(
        np.array([[0.25, 0.1], [0.1, 0.16]]), abs=0.02)
    assert found.estimate.covariance[2, 2] == pytest.approx(0.01, rel=0.1)


def test_a_robot_that_was_put_elsewhere_with_its_odometry_is_there_and_as_sure():
    found = localisation()
    found.start_at((4, 4, 0), CLOSE)
    found.add((0, 0, 0), SEEN)
    before, place = found.particles, found.map_to_odom
    found.jump_to(np.array([-2.0, 1.0, 2.0]))
    assert not found.add((-2.0, 1.0, 2.0), SEEN).weighed
    assert found.particles == pytest.approx(poses.compose(before, (-2.0, 1.0, 2.0)))
    assert (found.map_to_odom == place).all()
