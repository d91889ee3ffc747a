"""The checks that run the learner's file as a node; once by the command that a learner types."""

import subprocess
import sys
from pathlib import Path

import pytest
import rospkg

from exercises.catalogue import find_exercises

pytestmark = pytest.mark.processes
LESSON = rospkg.RosPack().get_path("learning_service")
TYPED = ["rosrun", "exercises", "check_exercise"]
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


def written(name, file, *changes):
    """The solution with parts of it written otherwise, in a file."""
    text = find_exercises()[name].solution.read_text(encoding="utf-8")
    for part, other in changes:
        assert part in text
        text = text.replace(part, other)
    file.write_text(text, encoding="utf-8")
    return file


def test_a_result_may_come_after_the_status_that_has_its_end(tmp_path):
    """As over a slow connection: they are two topics."""
    late = """import time
publish_result = actionlib.ActionServer.publish_result
def late(self, *what):
    self.publish_status()
    time.sleep(0.5)
    publish_result(self, *what)
actionlib.ActionServer.publish_result = late
RATE_HZ"""
    file = written("refuse_goal", tmp_path / "mine.py", ("RATE_HZ = ", f"{late} = "))
    done = check(SCRIPT, "refuse_goal", file)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_goal_that_never_ends_has_no_end(tmp_path):
    file = written("refuse_goal", tmp_path / "mine.py", (
        "self.server.set_aborted", "while not self.server.is_new_goal_available(): rospy.sleep"),
        ('AddIntsResult(), "num must be 1 or more"', "0.1"))
    done = check(SCRIPT, "refuse_goal", file)
    assert "end of the goal 0: none, wanted ABORTED" in done.stdout, done.stdout + done.stderr


SLOW_TO_SEND = """import runpy, sys, time
import actionlib
send_goal = actionlib.ActionClient.send_goal
def slow(self, *what, **more):
    handle = send_goal(self, *what, **more)
    time.sleep(0.5)
    return handle
actionlib.ActionClient.send_goal = slow
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")"""


def test_a_goal_may_end_before_the_check_has_sent_it():
    """As on a busy machine: the server refuses at once, in another thread than the sender's."""
    solution = find_exercises()["refuse_goal"].solution
    done = check([sys.executable, "-c", SLOW_TO_SEND, SCRIPT[1]], "refuse_goal", solution)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "not tracking" not in done.stderr


def test_a_node_that_ends_by_itself_is_no_fault_of_the_check(tmp_path):
    """It has gone from the master's list when Ctrl-C is to be pressed."""
    file = written("stop_at_end", tmp_path / "mine.py", ("queue_size=1", "queue_size=None"), (
        "        driver.drive()\n",
        "        if driver.publisher.get_num_connections():\n            driver.drive()\n"
        "            rospy.signal_shutdown('')\n            time.sleep(0.5)\n"),
        ("        rospy.on_shutdown(self.stop)\n", ""))
    done = check(SCRIPT, "stop_at_end", file)
    assert done.returncode == 1 and "FAIL  " in done.stdout, done.stdout + done.stderr
    assert "Traceback" not in done.stderr, done.stderr


def test_a_toggle_fails_by_the_command_that_a_learner_types(tmp_path):
    solution, toggle = Path(LESSON) / "solutions/turtle_switch.py", tmp_path / "mine.py"
    toggle.write_text(solution.read_text(encoding="utf-8").replace(
        "self.driving = request.data", "self.driving = not self.driving"), encoding="utf-8")
    done = check(TYPED, "turtle_switch", toggle)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "FAIL  after /turtle_drive true: the turtle stands, wanted the turtle drives" \
        in done.stdout
