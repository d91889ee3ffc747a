"""A check that runs the learner's file as a node, by the command that a learner types."""

import subprocess

import pytest
import rospkg

pytestmark = pytest.mark.processes
LESSON = rospkg.RosPack().get_path("learning_service")
COMMAND = ["rosrun", "evaluation", "check_exercise", "turtle_switch"]


def check(*file):
    return subprocess.run([*COMMAND, *file], capture_output=True, text=True, timeout=120)


def test_the_starting_file_fails_and_the_solution_passes():
    begun, solved = check(), check(f"{LESSON}/solutions/turtle_switch.py")
    assert begun.returncode == 1, begun.stdout + begun.stderr
    assert "FAIL  after /turtle_drive true: the turtle stands, wanted the turtle drives" \
        in begun.stdout
    assert solved.returncode == 0, solved.stdout + solved.stderr
    assert solved.stdout.splitlines()[-1] == "passed, 8 of 8"


def test_a_node_that_ends_is_one_line(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text("raise SystemExit('no turtle here')\n", encoding="utf-8")
    done = check(str(file))
    assert done.returncode == 1
    assert done.stdout.splitlines()[-1] == f"FAIL  {file}: ended, exit code 1: no turtle here"
