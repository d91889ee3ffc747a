"""The lessons' C++ programs: each shows what lesson_commands.yaml expects of its script."""

import importlib.util
import os
import signal
import subprocess
import time
from contextlib import closing
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
HERE = Path(__file__).resolve().parent
_spec = importlib.util.spec_from_file_location("scenarios", HERE / "scenarios.py")
scenarios = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(scenarios)
CASES = [pytest.param(scenario, id=f"{package}: {scenario['name']}")
         for package, listed in scenarios.twins().items() for scenario in listed]


def test_every_program_is_started():
    source = HERE.parents[1]
    programs = {path.stem for folder in ("learning_topic", "lessons/learning_*")
                for path in source.glob(f"{folder}/src/*.cpp")} - {"describe", "use_library"}
    typed = " ".join(step["type"] for listed in scenarios.twins().values() for scenario in listed
                     for step in scenario["terminals"]).split()
    launched = {"multi_tf_sub", "generate_new", "demo04_pub", "demo04_sub"}  # by cpp:=true
    assert programs - set(typed) == launched


@pytest.fixture(scope="module")
def roscore(tmp_path_factory):
    with closing(scenarios.Roscore(tmp_path_factory.mktemp("roscore"))) as one:
        yield one


@pytest.mark.parametrize("program", ["static_tf_sub.py", "static_tf_sub"])
def test_a_frame_that_is_not_there_is_no_line_each_second(program, roscore, tmp_path):
    there = os.environ | {"ROS_MASTER_URI": f"http://localhost:{roscore.cleared()}"}
    shown = tmp_path / "shown"
    with shown.open("w") as file, subprocess.Popen(
            ["rosrun", "learning_tf", program], env=there, stdout=file, stderr=file) as node:
        limit = time.monotonic() + 60
        while "not yet: " not in shown.read_text():
            assert time.monotonic() < limit
            time.sleep(0.1)
        time.sleep(3.0)  # in which it looks three times more
        node.send_signal(signal.SIGINT)
    assert shown.read_text().count("not yet: ") == 1


@pytest.mark.parametrize("scenario", CASES)
def test_program(scenario, tmp_path, roscore):
    problem = scenarios.run(scenario, tmp_path, roscore)
    assert not problem, problem
