"""The commands of the lessons that start the simulator, typed in real terminals."""

import importlib.util
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
_spec = importlib.util.spec_from_file_location(
    "scenarios", Path(__file__).resolve().with_name("scenarios.py"))
scenarios = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(scenarios)
CASES = [pytest.param(scenario, id=f"{package}: {scenario['name']}")
         for package in sorted(scenarios.SIMULATED) for scenario in scenarios.SCENARIOS[package]]


@pytest.mark.parametrize("scenario", CASES)
def test_commands(scenario, tmp_path):
    problem = scenarios.run(scenario, tmp_path)
    assert not problem, problem
