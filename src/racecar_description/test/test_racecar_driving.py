"""The car and its gains against the laws they obey: steps, circles, braking, standing."""

import math

import numpy as np
import pytest
from racecar_in_world import AXLES, HINGES, MIDDLE, WHEEL_RADIUS, WHEELBASE, Car, at

from bullet_sim.pose import Pose


@pytest.fixture
def car():
    racecar = Car()
    yield racecar
    racecar.world.close()


def recorded(car, joint, since):
    return np.array([step[joint] for step in car.history[since:]])


def test_it_stands_level_and_does_not_creep(car):
    car.run(1.0)
    before = car.model.pose
    car.run(5.0)
    roll, pitch, yaw = car.model.pose.rpy()
    assert car.model.pose.position == pytest.approx(before.position, abs=5e-4)
    assert abs(car.model.pose.position[2]) < 5e-4
    assert max(abs(roll), abs(pitch)) < 1e-3
    assert abs(yaw - before.rpy()[2]) < 1e-3


@pytest.mark.parametrize("speed", [0.0, 1.0])
@pytest.mark.parametrize("angle", [0.34, -0.1])
def test_a_hinge_goes_where_it_is_told(car, angle, speed):
    """Standing as well as driving: within 2 % and 0.3 s, and never 5 % beyond."""
    car.wheels(speed / WHEEL_RADIUS)
    car.run(0.3)
    since = len(car.history)
    for hinge in HINGES:
        car.joints[hinge].command = angle
    car.run(0.6)
    for hinge in HINGES:
        parts = recorded(car, hinge, since) / angle
        assert np.abs(parts[300:] - 1).max() < 0.02
        assert parts.max() < 1.05


@pytest.mark.parametrize("speed", [0.5, 2.0])
def test_a_wheel_reaches_its_rate(car, speed):
    """At least 90 % of the command, 5 % beyond it at most; and the car rolls as its wheels do."""
    car.wheels(speed / WHEEL_RADIUS)
    car.run(0.6)
    for axle in AXLES:
        parts = recorded(car, axle, 0) * WHEEL_RADIUS / speed
        assert parts[-1] > 0.99 and parts[400:].min() > 0.9
        assert parts.max() < 1.05
    assert car.speed() == pytest.approx(speed, rel=0.01)


def test_a_wheel_off_the_ground_does_not_chatter(car):
    """One step of the controller must not throw a free wheel beyond twice its error."""
    car.world.configure_physics(gravity=(0.0, 0.0, 0.0))
    car.model.set_pose(Pose((0.0, 0.0, 1.0)))
    car.wheels(20.0)
    car.run(0.2)
    for axle in AXLES:
        assert recorded(car, axle, 150) == pytest.approx(20.0, rel=0.01)


def fitted_circle(points):
    """Least squares: x^2 + y^2 = 2 a x + 2 b y + c."""
    points = np.array(points)
    rows = np.column_stack([2 * points, np.ones(len(points))])
    a, b, c = np.linalg.lstsq(rows, (points ** 2).sum(axis=1), rcond=None)[0]
    return math.sqrt(c + a * a + b * b)


@pytest.mark.parametrize(("angle", "start"), [
    (0.34, at(0.0, -1.0)), (-0.2, at(0.0, 1.65)), (0.1, at(0.0, -3.35))])
def test_a_circle_has_the_radius_of_its_steering_angle(angle, start):
    car = Car(pose=start)
    car.drive(1.0, angle)
    car.run(0.5)
    points = []
    for _ in range(40):
        car.run(0.1)
        points.append(car.model.pose.position[:2])
    assert fitted_circle(points) == pytest.approx(WHEELBASE / math.tan(abs(angle)), rel=0.03)
    assert car.speed() == pytest.approx(1.0, rel=0.01)
    car.world.close()


@pytest.mark.parametrize("angle", [0.0, 0.15])
def test_it_stops_from_2_metres_a_second_in_a_quarter_of_a_second(angle):
    """With its wheels on the ground and without turning round, however hard it pulls."""
    car = Car(pose=at(-3.0, -2.6))
    car.drive(2.0, angle)
    attitudes = []
    for _ in range(80):
        car.run(0.01)
        attitudes.append((car.model.pose.position[2], *car.model.pose.rpy()[:2]))
    assert car.speed() == pytest.approx(2.0, rel=0.01)
    yaw = car.model.pose.rpy()[2]
    car.drive(0.0, angle)
    for _ in range(25):
        car.run(0.01)
        attitudes.append((car.model.pose.position[2], *car.model.pose.rpy()[:2]))
    assert car.speed() < 0.02
    assert abs(car.model.pose.rpy()[2] - yaw) < 0.2
    assert np.abs(attitudes).max() < 2e-3
    car.world.close()


def test_it_goes_backwards_as_well(car):
    car.wheels(-1.0 / WHEEL_RADIUS)
    car.run(1.0)
    assert car.model.twist.linear[0] == pytest.approx(-1.0, rel=0.01)


def test_a_wall_holds_it():
    """Head-on at 2 m/s it neither climbs the wall nor passes it."""
    car = Car(pose=at(4.0, 0.0))
    car.wheels(2.0 / WHEEL_RADIUS)
    highest = 0.0
    for _ in range(150):
        car.run(0.01)
        highest = max(highest, car.model.pose.position[2])
    assert car.model.pose.position[0] < MIDDLE[0] + 6.0
    assert highest < 0.05
    assert max(map(abs, car.model.pose.rpy()[:2])) < 0.3
    car.world.close()
