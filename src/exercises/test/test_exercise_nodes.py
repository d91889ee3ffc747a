"""A check that runs the learner's file as a node; once by the command that a learner types."""

import subprocess
import sys
from pathlib import Path

import pytest
import rospkg

pytestmark = pytest.mark.processes
LESSON = rospkg.RosPack().get_path("learning_service")
TYPED = ["rosrun", "evaluation", "check_exercise"]
SCRIPT = [sys.executable, str(Path(__file__).resolve().parents[1] / "scripts/check_exercise")]


def check(command, *file):
    return subprocess.run([*command, "turtle_switch", *file], capture_output=True, text=True,
                          timeout=120)


def test_a_toggle_fails_and_the_solution_passes(tmp_path):
    solution = Path(LESSON) / "solutions/turtle_switch.py"
    toggle = tmp_path / "mine.py"
    toggle.write_text(solution.read_text(encoding="utf-8").replace(
        "self.driving = request.data", "self.driving = not self.driving"), encoding="utf-8")
    begun, solved = check(TYPED, str(toggle)), check(SCRIPT, str(solution))
    assert begun.returncode == 1, begun.stdout + begun.stderr
    assert "FAIL  after /turtle_drive true: the turtle stands, wanted the turtle drives" \
        in begun.stdout
    assert solved.returncode == 0, solved.stdout + solved.stderr
    assert solved.stdout.splitlines()[-1] == "passed, 8 of 8"
