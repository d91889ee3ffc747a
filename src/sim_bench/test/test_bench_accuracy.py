"""The drives that the part accuracy compares are those it says."""

import math

import pytest
from sim_bench.driven import ROBOTS, TRACK
from sim_bench.parts import accuracy

SPEED = 0.15  # m/s
RAMP = SPEED ** 2 / 2  # m, by which a ramp of 1 m/s^2 falls behind
DRIVEN = 5.0 * SPEED - RAMP  # m


@pytest.mark.parametrize("robot", [robot for robot in ROBOTS if robot != "burger"])  # it slides
@pytest.mark.parametrize("kind", ["straight", "circle"])
def test_a_robot_drives_as_far_as_told(robot, kind):
    way = accuracy.drive(robot, kind, SPEED, accuracy.WAYS["ours"])
    assert way.distance == pytest.approx(1e3 * DRIVEN, rel=0.03)
    turned = math.degrees(DRIVEN / accuracy.CIRCLE.get(robot, 0.5)) if kind == "circle" else 0.0
    slips = 0.35 if robot == "skid" else 0.05  # its wheels scrub in a turn
    assert way.yaw == pytest.approx(turned, rel=slips, abs=0.1)
    assert way.step > 1.0


def test_on_the_spot_it_turns_by_its_track():
    way = accuracy.drive("waffle", "spot", SPEED, accuracy.WAYS["ours"])
    assert way.yaw == pytest.approx(math.degrees(2 * DRIVEN / TRACK["waffle"]), rel=0.03)
    assert way.distance < 2.0


def test_there_are_figures_of_errors_and_time(monkeypatch):
    monkeypatch.setattr(accuracy, "DRIVING", 200)
    found = {each.name: each for each in accuracy._compare("sprung", "bump", (SPEED, 0.5))}
    assert set(found) == {f"{what}.sprung.bump.{way}"
                          for what in ("yaw_error", "distance_error", "step")
                          for way in ("ours", "coarse")}
    assert all(len(each.runs) == 2 and each.min >= 0.0 for each in found.values())
