"""send_goal.py: what is no place is said before anything is asked, and Ctrl-C ends it quietly."""

import importlib.util
import os
import signal
import subprocess
import sys
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


def test_ctrl_c_while_no_master_answers():
    """About 2 s."""
    environment = {**os.environ, "ROS_MASTER_URI": "http://localhost:1", "PYTHONUNBUFFERED": "1"}
    child = subprocess.Popen([sys.executable, SCRIPT, "1", "1"], env=environment, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        first = child.stdout.readline()
        child.send_signal(signal.SIGINT)
        rest = child.communicate(timeout=20)[0]
    finally:
        child.kill()
    assert "Unable to register with master" in first
    assert "Traceback" not in rest and child.returncode == 1
