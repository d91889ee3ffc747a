"""The fake robot: its arithmetic, and its launch file as roslaunch's own loader reads it."""

import math
from pathlib import Path

import pytest
from roslaunch.config import ROSLaunchConfig
from roslaunch.xmlloader import XmlLoader
from turtlebot3_fake.wheels import Wheels, roll, separation, velocity, wheel_speeds


def drive(linear, angular, seconds, model="burger", rate_hz=30):
    apart, wheels = separation(model), Wheels()
    for _ in range(round(seconds * rate_hz)):
        wheels = roll(wheels, wheel_speeds(linear, angular, apart), apart, 1 / rate_hz)
    return wheels, apart


def test_straight():
    wheels, apart = drive(0.2, 0.0, 5)
    assert (wheels.x, wheels.y, wheels.yaw) == pytest.approx((1.0, 0.0, 0.0))
    assert wheels.angles == pytest.approx((1.0 / 0.033, 1.0 / 0.033))
    assert velocity(wheels, apart) == pytest.approx((0.2, 0.0))


def test_on_the_spot_the_wheels_turn_against_each_other():
    wheels, _ = drive(0.0, 1.0, math.pi / 2)
    assert (wheels.x, wheels.y) == pytest.approx((0.0, 0.0))
    assert wheels.yaw == pytest.approx(math.pi / 2, abs=0.02)
    assert wheels.angles[0] == -wheels.angles[1] < 0


def test_a_circle_ends_where_it_began():
    wheels, _ = drive(0.1, 0.2, math.tau / 0.2, rate_hz=100)
    assert (wheels.x, wheels.y) == pytest.approx((0.0, 0.0), abs=2e-3)


@pytest.mark.parametrize("model, apart", [("burger", 0.16), ("waffle", 0.287),
                                          ("waffle_pi", 0.287), ("other", 0.16)])
def test_separations_are_the_plugins(model, apart):
    assert separation(model) == apart


FILE = Path(__file__).resolve().parents[1] / "launch" / "turtlebot3_fake.launch"


def rviz(*arguments):
    """The node of that name as (package, type), or None."""
    config = ROSLaunchConfig()
    XmlLoader().load(str(FILE), config, argv=[str(FILE), *arguments], verbose=False)
    return next(((node.package, node.type) for node in config.nodes if node.name == "rviz"), None)


@pytest.mark.parametrize("display, shown", [
    (":0", ("rviz", "rviz")), ("", ("turtlebot3_bringup", "no_screen")),
])
def test_rviz_needs_a_screen(monkeypatch, display, shown):
    monkeypatch.setenv("DISPLAY", display)
    assert rviz() == shown
    assert rviz("open_rviz:=false") is None
