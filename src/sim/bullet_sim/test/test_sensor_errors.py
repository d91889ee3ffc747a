"""Noise, drift, places on Earth, and rates that are rounded to steps, against closed forms."""

import math

import numpy as np
import pytest

from bullet_sim.description import Noise
from bullet_sim.sensors.error_model import ErrorModel, ErrorParameters, attitude_error
from bullet_sim.sensors.geo_reference import GeoReference
from bullet_sim.sensors.noise import SensorNoise
from bullet_sim.tick_rate import TickRate
from bullet_sim.world import World


@pytest.fixture
def world():
    made = World(seed=3)
    yield made
    made.close()


@pytest.mark.parametrize("rate_hz", [20, 500])
def test_a_drift_keeps_its_deviation_at_any_rate(world, rate_hz):
    parameters = ErrorParameters((0.0,), (0.3,), (20.0,), (0.0,), (1.0,))
    model = ErrorModel(world, "m", parameters)
    drifts = []
    for _ in range(4000):
        world.tick += 1
        drifts.append(model.update(1.0 / rate_hz)[0])
    assert np.std(drifts) == pytest.approx(0.3, rel=0.25)
    memory = np.corrcoef(drifts[:-1], drifts[1:])[0, 1]
    assert memory == pytest.approx(math.exp(-20.0 / rate_hz), abs=0.05)


def test_a_sensor_without_errors_tells_the_truth(world):
    model = ErrorModel(world, "m", ErrorParameters.none(3))
    assert model.apply(np.array([1.0, 2.0, 3.0]), 0.1).tolist() == [1.0, 2.0, 3.0]
    assert not model.drifts


def test_white_noise_has_its_deviation_about_the_scaled_value_and_the_offset(world):
    model = ErrorModel(world, "m", ErrorParameters(
        (0.5, 0.0), (0.0, 0.0), (1.0, 1.0), (0.2, 0.1), (2.0, 1.0)))
    readings = []
    for _ in range(4000):
        world.tick += 1
        readings.append(model.apply(np.array([3.0, 0.0]), 0.01))
    assert np.mean(readings, axis=0) == pytest.approx([6.5, 0.0], abs=0.015)
    assert np.std(readings, axis=0) == pytest.approx([0.2, 0.1], rel=0.05)
    assert np.corrcoef(np.transpose(readings))[0, 1] == pytest.approx(0.0, abs=0.05)


def test_only_quantized_readings_come_in_steps(world):
    plain, quantized = (
        SensorNoise(world, "m", [Noise(kind, 0.0, 0.3, precision=0.25)]).apply(np.full(400, 1.0))
        for kind in ("gaussian", "gaussian_quantized"))
    assert np.std(plain) == pytest.approx(0.3, rel=0.15)
    assert np.array_equal(quantized, np.round(plain * 4) / 4)
    assert not np.array_equal(quantized, plain)


@pytest.mark.parametrize("parameters, constant", [
    (ErrorParameters((0.0,), (0.0,), (2.0,), (0.0,), (1.0,)), 0.5),
    (ErrorParameters.none(1), 3600.0)])  # sensor_model.h: an hour
def test_a_drift_that_is_set_dies_away_with_its_time_constant(world, parameters, constant):
    model = ErrorModel(world, "m", parameters)
    model.set_drift(np.array([1.0]))
    assert model.drifts
    assert model.update(constant)[0] == pytest.approx(math.exp(-1.0))


def test_an_accelerometers_bias_tilts_by_its_share_of_gravity():
    x, y, z, w = attitude_error(np.array([0.0, 0.98, 5.0]), 0.0, 9.8)
    assert (2 * x, y, z) == pytest.approx((0.1, 0.0, 0.0), abs=1e-3)
    assert math.hypot(x, y, z, w) == pytest.approx(1.0)
    assert attitude_error(np.zeros(3), 0.5, 0.0) == pytest.approx(
        (0.0, 0.0, math.sin(0.25), math.cos(0.25)))


def test_a_degree_on_earth_has_the_length_it_has():
    # WGS84: a degree of latitude at 45 degrees is 111 132 m, one of longitude 78 847 m.
    north = GeoReference(45.0, 7.0, 100.0, heading=0.0)
    latitude, longitude, altitude = north.geodetic((111_132.0, 0.0, 5.0))
    assert (latitude, longitude, altitude) == pytest.approx((46.0, 7.0, 105.0), abs=1e-5)
    east = GeoReference(45.0, 7.0, 100.0, heading=math.pi / 2)
    assert east.geodetic((78_847.0, 0.0, 0.0))[:2] == pytest.approx((45.0, 8.0), abs=1e-5)
    assert east.north_west_up((1.0, 0.0, 2.0)) == pytest.approx((0.0, -1.0, 2.0), abs=1e-12)


def test_a_bias_goes_either_way_as_often(world):
    """Gazebo's GaussianNoiseModel tosses a coin for the sign."""
    noise = Noise("gaussian", 0.0, 0.0, bias_mean=0.5)
    biases = [SensorNoise(world, f"s{number}", [noise]).bias.item() for number in range(100)]
    assert set(biases) == {-0.5, 0.5}
    assert 30 < biases.count(0.5) < 70


def test_noise_is_a_function_of_seed_name_and_tick(world):
    noise = Noise("gaussian", 0.0, 1.0, bias_stddev=1.0)
    first = SensorNoise(world, "a", [noise]).apply(np.zeros(4))
    assert SensorNoise(world, "a", [noise]).apply(np.zeros(4)).tolist() == first.tolist()
    assert SensorNoise(world, "b", [noise]).apply(np.zeros(4)).tolist() != first.tolist()


@pytest.mark.parametrize("rate_hz, whole_steps, due", [
    (30.0, False, [34, 67, 100]), (30.0, True, [34, 68, 102]), (50.0, True, [20, 40, 60]),
    (0.0, True, [1, 2, 3]), (5000.0, True, [1, 2, 3])])
def test_rates_that_are_counted_from_the_last_time(rate_hz, whole_steps, due):
    tick_rate = TickRate(rate_hz, 0.001, whole_steps=whole_steps)
    ticks = [0]
    for _ in due:
        ticks.append(tick_rate.next_tick(ticks[-1]))
    assert ticks[1:] == due
