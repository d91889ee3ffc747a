"""send_goal.py: what is no place is said before anything is asked."""

import importlib.util
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[1] / "scripts" / "send_goal.py"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("send_goal", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("words, place", [
    (["1.5", "-1.5", "90"], (1.5, -1.5, 90.0)), (["1", "2"], (1.0, 2.0, 0.0))])
def test_a_place(script, words, place):
    assert script.place_of(words) == place


@pytest.mark.parametrize("words", [[], ["1"], ["1", "two"], ["nan", "1"], ["1", "inf"],
                                   ["1", "1", "90", "5"]])
def test_no_place(script, words):
    with pytest.raises(SystemExit, match=r"which place\? e\.g\. rosrun nav_demo send_goal\.py"):
        script.place_of(words)
