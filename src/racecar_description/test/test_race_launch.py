"""What race.launch sets, without a master."""

from pathlib import Path

import pytest
import yaml
from roslaunch.config import load_config_default

PACKAGE = Path(__file__).resolve().parent.parent
BRAKES = 8.0  # m/s^2, measured: from 2.2 m/s in 0.28 s
STANDS = 0.7  # s, after the last command
ARRIVES = 0.04  # s, until that command moves the wheels


@pytest.mark.parametrize("lockstep, rate_hz", [("", None), ("/motor_output", 0.0)])
def test_a_car_whose_follower_hangs_stands_in_time_at_its_greatest_speed(lockstep, rate_hz):
    file = str(PACKAGE / "launch" / "race.launch")
    config = load_config_default([(file, [f"lockstep:={lockstep}"])], None, verbose=False)
    values = {name: param.value for name, param in config.params.items()}
    settings = PACKAGE.parent / "car_control" / "config" / "lane_follow.yaml"
    fastest = yaml.safe_load(settings.read_text(encoding="utf-8"))["max_speed"]
    assert values["/motor_control/timeout"] + fastest / BRAKES + ARRIVES <= STANDS
    assert values.get("/motor_control/rate_hz") == rate_hz
