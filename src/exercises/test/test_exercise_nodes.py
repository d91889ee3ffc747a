"""The checks that run the learner's file as a node; once by the command that a learner types."""

import subprocess
import sys
from pathlib import Path

import pytest
import rospkg

pytestmark = pytest.mark.processes
LESSON = rospkg.RosPack().get_path("learning_service")
TYPED = ["rosrun", "evaluation", "check_exercise"]
SCRIPT = [sys.executable, str(Path(__file__).resolve().parents[1] / "scripts/check_exercise")]


def check(command, *arguments):
    return subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120)


def test_the_starting_file_fails_and_the_solution_passes(node_exercise, begun):
    start = begun(node_exercise)
    if start is not None:
        failed = check(SCRIPT, node_exercise.name, start)
        assert failed.returncode == 1, failed.stdout + failed.stderr
        assert "\nFAIL  " in failed.stdout
    solved = check(SCRIPT, node_exercise.name, node_exercise.solution)
    assert solved.returncode == 0, solved.stdout + solved.stderr
    assert solved.stdout.splitlines()[-1].startswith("passed, ")


def test_a_toggle_fails_by_the_command_that_a_learner_types(tmp_path):
    solution, toggle = Path(LESSON) / "solutions/turtle_switch.py", tmp_path / "mine.py"
    toggle.write_text(solution.read_text(encoding="utf-8").replace(
        "self.driving = request.data", "self.driving = not self.driving"), encoding="utf-8")
    done = check(TYPED, "turtle_switch", toggle)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "FAIL  after /turtle_drive true: the turtle stands, wanted the turtle drives" \
        in done.stdout
