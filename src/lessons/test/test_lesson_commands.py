"""Every command of the lessons' READMEs, typed in real terminals; lesson_commands.yaml has them.

`python3 -m pytest -v src/lessons/test` prints the list with results.
"""

import importlib.util
import os
import re
from contextlib import closing
from pathlib import Path
from xmlrpc.client import ServerProxy

import pytest

pytestmark = pytest.mark.processes
HERE = Path(__file__).resolve().parent
LESSONS = HERE.parent
PACKAGES = sorted(manifest.parent.name for manifest in LESSONS.glob("*/package.xml"))
FENCE = re.compile(r"^```bash\n(.*?)^```", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`((?:rosrun \S+|roslaunch \S+ \S+\.launch)\b[^`…]*)`")
_spec = importlib.util.spec_from_file_location("scenarios", HERE / "scenarios.py")
scenarios = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(scenarios)
CASES = [pytest.param(scenario, id=f"{package}: {scenario['name']}")
         for package, listed in scenarios.SCENARIOS.items() for scenario in listed
         if package not in scenarios.SIMULATED]


def commands_in(readme: Path) -> set[str]:
    """Those of its bash fences, and rosrun and roslaunch lines between backquotes.

    Not `export ROS_...=`: addresses of the reader's machines, where a test has its own master.
    """
    text = readme.read_text(encoding="utf-8")
    fenced = "".join(FENCE.findall(text)).splitlines()
    inline = INLINE.findall(FENCE.sub("", text))
    return {" ".join(line.split()) for line in [*fenced, *inline]
            if line.strip() and not line.startswith("export ROS_")}


def typed_in(package: str) -> set[str]:
    """What the list types for a package."""
    listed = [*scenarios.SCENARIOS.get(package, []), *scenarios.twins().get(package, [])]
    return {" ".join(step["type"].split()) for scenario in listed
            for step in scenario["terminals"]}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_list_types_every_command_of_the_readme(package):
    english, chinese = (commands_in(LESSONS / package / name)
                        for name in ("README.md", "README.zh-CN.md"))
    assert english == chinese
    here = {command for command in english
            if not any(re.fullmatch(row["match"], command) for row in scenarios.ELSEWHERE)}
    assert here <= typed_in(package)


@pytest.mark.parametrize("row", scenarios.ELSEWHERE, ids=lambda row: row["match"])
def test_what_tests_a_command_elsewhere_is_there(row):
    assert (LESSONS.parents[1] / row["by"]).is_file()


def test_a_terminal_stays_for_what_a_command_leaves_behind(tmp_path):
    terminal = scenarios.terminals.Terminal("(sleep 0.5; touch closed) & exit 3", tmp_path,
                                            os.environ)
    assert terminal.wait_until_ended(3) is None
    terminal.close()
    assert (tmp_path / "closed").exists()


@pytest.fixture(scope="module")
def roscore(tmp_path_factory):
    with closing(scenarios.Roscore(tmp_path_factory.mktemp("roscore"))) as one:
        yield one


def test_a_scenario_finds_nothing_of_one_before(roscore):
    port = roscore.cleared()
    with ServerProxy(f"http://localhost:{port}") as master:
        master.setParam("/me", "/turtlesim/background_r", 1)
        assert roscore.cleared() == port
        assert master.hasParam("/me", "/turtlesim")[2] is False
        master.registerSubscriber("/me", "/topic", "*", "http://localhost:1")  # and is killed
    assert roscore.cleared() != port


@pytest.mark.parametrize("scenario", CASES)
def test_commands(scenario, tmp_path, roscore):
    problem = scenarios.run(scenario, tmp_path, roscore)
    assert not problem, problem
