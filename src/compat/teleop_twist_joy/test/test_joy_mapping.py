"""Joysticks held in known ways."""

from pathlib import Path

import pytest
import yaml
from teleop_twist_joy.mapping import ZERO, Teleop

CONFIGS = sorted(Path(__file__).parent.parent.glob("config/*.yaml"))


def test_upstreams_defaults():
    teleop = Teleop({})
    assert teleop.command([0.5, 1.0], [1]) == (0.5, 0.0, 0.0, 0.0, 0.0, 0.25)


def test_one_zero_when_the_button_comes_up_and_then_nothing():
    teleop = Teleop({})
    assert teleop.command([0.0, 1.0], [1]) != ZERO
    assert [teleop.command([0.0, 1.0], [0]) for _ in range(3)] == [ZERO, None, None]
    assert teleop.command([0.0, 1.0], [1])[0] == 0.5
    assert teleop.command([0.0, 1.0], [0]) == ZERO


def test_turbo_comes_first_and_turns_no_faster_unless_told():
    teleop = Teleop({"enable_turbo_button": 1, "scale_angular": 2.0})
    assert teleop.command([0.5, 1.0], [1, 1]) == (1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def test_named_axes():
    teleop = Teleop({"axis_linear": {"x": 1, "y": 0, "z": 7}, "scale_linear": {"x": 2.0, "y": 3.0},
                     "axis_angular": {"roll": 2, "pitch": 3}, "scale_angular": {"roll": 1.0}})
    assert teleop.command([0.1, 0.2, 0.3, 0.4], [1]) == pytest.approx((0.4, 0.3, 0, 0.3, 0, 0))


@pytest.mark.parametrize("parameters, said", [
    ({"scale_linear": "fast"}, "scale_linear is 'fast', not a number"),
    ({"axis_linear": {"x": 1}, "scale_linear": 0.5}, "one scale for each")])
def test_parameters_of_another_kind(parameters, said):
    with pytest.raises(ValueError, match=said):
        Teleop(parameters)


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.stem)
def test_shipped_configurations_drive(path):
    teleop = Teleop(yaml.safe_load(path.read_text(encoding="utf-8")))
    buttons = [int(i == teleop.enable) for i in range(12)]
    assert teleop.command([0.0, 1.0, 0.0], buttons)[0] > 0.3
