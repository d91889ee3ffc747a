"""The racecar between two walls, by navigation.launch: straight on, then about in a narrow road.

About 45 s. The same trial with more goals, on a map that the car has made itself:
racecar_mapping_trial.py and racecar_goals_trial.py.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

pytestmark = pytest.mark.processes
TRIAL = Path(__file__).with_name("racecar_goals_trial.py")
GOALS = [{"name": "straight on", "x": 1.5, "y": 0.0, "degrees": 0, "least_turns": 0},
         {"name": "about", "x": 1.5, "y": 0.0, "degrees": 180, "least_turns": 2}]


def test_forwards_and_a_three_point_turn(tmp_path):
    goals = tmp_path / "goals.yaml"
    goals.write_text(yaml.safe_dump(GOALS), encoding="utf-8")
    done = subprocess.run([sys.executable, TRIAL, tmp_path, "--map", "drawn", "--goals", goals],
                          capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads((tmp_path / "goals.json").read_text(encoding="utf-8"))
    ahead, about = found["goals"]
    assert ahead["turns_of_direction"] == 0
    assert about["driven_m"] < 6.0
    assert min(ahead["clearance_m"], about["clearance_m"]) > 0.02
