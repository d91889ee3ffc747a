"""When the car drives, when it stands, and within what limits."""

import math
import runpy
from dataclasses import replace
from pathlib import Path
from unittest.mock import MagicMock

import pytest
import rospy
from car_control.motor import DriveCommand, Motor, MotorSettings, controller_commands
from geometry_msgs.msg import Twist
from node_basics.settings import load_settings

CONFIG = Path(__file__).parents[1] / "config" / "car_control.yaml"
SCRIPT = CONFIG.parents[1] / "scripts" / "motor_control.py"
PAGE = load_settings(MotorSettings, CONFIG, "motor_control")
SETTINGS = replace(PAGE, ackermann=True)


def driving(speed=2.0, angle=0.1, at=10.0, **changes):
    motor = Motor(replace(SETTINGS, **changes))
    motor.take(DriveCommand(speed, angle), at)
    return motor


def test_a_command_stands_until_its_time_is_out():
    motor = driving()
    assert motor.drive(10.0) == motor.drive(10.5) == DriveCommand(2.0, 0.1)
    assert motor.drive(10.51) == DriveCommand(0.0, 0.1)


def test_nothing_is_driven_before_the_first_command():
    assert Motor(SETTINGS).drive(0.0) == DriveCommand(0.0, 0.0)


def test_a_stop_is_for_good_even_if_the_clock_is_set_back():
    motor = driving()
    assert motor.drive(9.0).speed == 0.0
    assert motor.drive(10.2).speed == 0.0


def test_an_emergency_stop_stands_above_all_commands():
    motor = driving()
    motor.emergency = True
    motor.take(DriveCommand(1.0, 0.0), 10.1)
    assert motor.drive(10.1).speed == 0.0
    motor.emergency = False
    assert motor.drive(10.2) == DriveCommand(1.0, 0.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_as_if_it_had_not_come(bad):
    motor = driving()
    for command in (DriveCommand(bad, 0.0), DriveCommand(1.0, bad)):
        with pytest.raises(ValueError, match="must be finite"):
            motor.take(command, 10.4)
    assert motor.drive(10.4) == DriveCommand(2.0, 0.1)
    assert motor.drive(10.6).speed == 0.0


def test_speed_and_angle_are_limited_both_ways():
    assert driving(99.0, 9.0).drive(10.0) == DriveCommand(5.0, 0.34)
    assert driving(-99.0, -9.0).drive(10.0) == DriveCommand(-5.0, -0.34)


def test_speeding_up_takes_time_and_slowing_down_none():
    motor = Motor(replace(SETTINGS, max_acceleration=2.0))
    motor.drive(10.0)
    motor.take(DriveCommand(1.0, 0.0), 10.0)
    assert motor.drive(10.1).speed == pytest.approx(0.2)
    assert motor.drive(10.3).speed == pytest.approx(0.6)
    motor.take(DriveCommand(0.5, 0.0), 10.3)
    assert motor.drive(10.3).speed == 0.5
    motor.take(DriveCommand(-1.0, 0.0), 10.4)
    assert motor.drive(10.4).speed == pytest.approx(-0.2)  # from standing, not from 0.5 m/s


def test_the_tutorials_law_is_the_pages():
    commands = controller_commands(PAGE, DriveCommand(2.0, -0.3))
    assert list(commands.values()) == [16.0] * 4 + [-0.3] * 2
    assert [name.split("_")[:2] for name in commands][:2] == [["left", "rear"], ["right", "rear"]]


def test_a_straight_drive_turns_all_wheels_alike():
    commands = controller_commands(SETTINGS, DriveCommand(2.0, 0.0))
    assert list(commands.values()) == [40.0] * 4 + [0.0] * 2


def test_a_car_that_cannot_steer_so_far_is_refused():
    with pytest.raises(ValueError, match=r"'max_steering_angle' must be less than 1\.047 rad"):
        replace(SETTINGS, wheelbase=0.2, max_steering_angle=1.1, front_track=0.23094)


def test_the_tutorial_s_node_sends_what_ours_does_by_its_law(monkeypatch):
    told = {}
    monkeypatch.setattr(rospy, "Subscriber", MagicMock())
    monkeypatch.setattr(rospy, "Publisher", lambda topic, *_, **__: MagicMock(
        publish=lambda value: told.__setitem__(topic, value)))
    page = runpy.run_path(str(CONFIG.parents[1] / "scripts" / "motor_control_page.py"))
    command = Twist()
    command.linear.x, command.angular.z = 1.5, -0.2
    page["MotorControl"]().take(command)
    ours = controller_commands(PAGE, DriveCommand(1.5, -0.2))
    assert told == {f"{PAGE.namespace}/{name}/command": value for name, value in ours.items()}


def test_every_table_of_car_control_is_complete_and_explained():
    # The nodes' own tables are loaded in test_motor.py and by the nodes; here: units are said.
    text = (Path(__file__).parents[1] / "config" / "car_control.yaml").read_text()
    keys = [line for line in text.splitlines() if line.startswith("  ")]
    assert keys and all("#" in line for line in keys)
