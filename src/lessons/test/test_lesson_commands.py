"""Every command of the lessons' READMEs, typed in real terminals; lesson_commands.yaml has them.

`python3 -m pytest -v src/lessons/test` prints the list with results.
"""

import importlib.util
import os
import re
from pathlib import Path

import pytest
import yaml

pytestmark = pytest.mark.processes
HERE = Path(__file__).resolve().parent
LESSONS = HERE.parent
SCENARIOS = yaml.safe_load((HERE / "lesson_commands.yaml").read_text(encoding="utf-8"))
ELSEWHERE = SCENARIOS.pop("tested elsewhere")
PACKAGES = sorted(manifest.parent.name for manifest in LESSONS.glob("*/package.xml"))
FENCE = re.compile(r"^```bash\n(.*?)^```", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`((?:rosrun \S+|roslaunch \S+ \S+\.launch)\b[^`…]*)`")
PROGRAM = re.compile(r"\brosrun (learning_\w+) (\w+)\.py")
LAUNCHED = re.compile(r"\broslaunch (learning_\w+) (\w+\.launch)")


def folder_of(package: str) -> Path:
    return next(folder for folder in (LESSONS / package, LESSONS.parent / package)
                if folder.is_dir())


def program_in_cpp(found: re.Match) -> str:
    """src/NAME.cpp beside scripts/NAME.py is started without .py."""
    there = (folder_of(found[1]) / "src" / f"{found[2]}.cpp").exists()
    return found[0].removesuffix(".py") if there else found[0]


def launched_in_cpp(found: re.Match) -> str:
    text = (folder_of(found[1]) / "launch" / found[2]).read_text(encoding="utf-8")
    return f"{found[0]} cpp:=true" if '<arg name="cpp"' in text else found[0]


def in_cpp(value):
    """A scenario, or a part of one, with the C++ program for each script that has one."""
    if isinstance(value, str):
        return LAUNCHED.sub(launched_in_cpp, PROGRAM.sub(program_in_cpp, value))
    if isinstance(value, list):
        return [in_cpp(each) for each in value]
    return {key: in_cpp(each) for key, each in value.items()} if isinstance(value, dict) else value


def both(scenario: dict) -> list[dict]:
    """The scenario, and the same up to the last step that says something of a C++ program."""
    steps = scenario["terminals"]
    twins = in_cpp(steps)
    until = max((number for number, twin in enumerate(twins, 1) if twin != steps[number - 1]),
                default=0)
    twin = {"name": f"{scenario['name']}, C++", "terminals": twins[:until]}
    return [scenario, twin] if until else [scenario]


SCENARIOS = {package: [each for scenario in scenarios for each in both(scenario)]
             for package, scenarios in SCENARIOS.items()}
CASES = [pytest.param(package, scenario, id=f"{package}: {scenario['name']}")
         for package, scenarios in SCENARIOS.items() for scenario in scenarios]

_spec = importlib.util.spec_from_file_location("terminals", HERE / "terminals.py")
terminals = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(terminals)


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
    return {" ".join(step["type"].split()) for scenario in SCENARIOS.get(package, [])
            for step in scenario["terminals"]}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_list_types_every_command_of_the_readme(package):
    english, chinese = (commands_in(LESSONS / package / name)
                        for name in ("README.md", "README.zh-CN.md"))
    assert english == chinese
    here = {command for command in english
            if not any(re.fullmatch(row["match"], command) for row in ELSEWHERE)}
    assert here <= typed_in(package)


@pytest.mark.parametrize("row", ELSEWHERE, ids=lambda row: row["match"])
def test_what_tests_a_command_elsewhere_is_there(row):
    assert (LESSONS.parents[1] / row["by"]).is_file()


def environment(folder: Path, port: int) -> dict[str, str]:
    """A terminal's on a machine without a screen, with a master of its own."""
    own = {"ROS_MASTER_URI": f"http://localhost:{port}", "ROS_HOSTNAME": "localhost",
           "ROS_HOME": str(folder / "ros"), "ROS_LOG_DIR": str(folder / "ros")}
    dropped = {"DISPLAY", "PYTHONUNBUFFERED", "ROS_IP"}
    return {name: value for name, value in os.environ.items() if name not in dropped} | own


def of_command(opened: list, command: str):
    return next(terminal for terminal in opened if terminal.command == command)


def take(step: dict, opened: list, folder: Path) -> str | None:
    """Waits for what the step promises of the last terminal; what is wrong, or None."""
    terminal = opened[-1]
    problem = terminal.wait_until_shown(step["shows"])
    if not problem and "keys" in step:
        of_command(opened, step.get("into", terminal.command)).type(step["keys"])
        problem = terminal.wait_until_shown(step["then"]) if "then" in step else None
    if not problem and "also" in step:
        problem = of_command(opened, step["also"]["in"]).wait_until_shown(step["also"]["shows"])
    if not problem and "ends" in step:
        problem = terminal.wait_until_ended(step["ends"])
    if not problem and "makes" in step and not (folder / step["makes"]).exists():
        problem = f"`{step['type']}` made no {step['makes']}"
    return problem


def test_a_terminal_stays_for_what_a_command_leaves_behind(tmp_path):
    terminal = terminals.Terminal("(sleep 0.5; touch closed) & exit 3", tmp_path, os.environ)
    assert terminal.wait_until_ended(3) is None
    terminal.close()
    assert (tmp_path / "closed").exists()


@pytest.mark.parametrize("package, scenario", CASES)
def test_commands(package, scenario, tmp_path):
    port, opened, problem = terminals.free_port(), [], None
    surroundings = environment(tmp_path, port)
    (tmp_path / "here").mkdir()
    try:
        for step in scenario["terminals"]:
            # roscore alone takes no notice of ROS_MASTER_URI's port.
            command = f"roscore -p {port}" if step["type"] == "roscore" else step["type"]
            if "in" in step:
                command = f"cd {step['in']} && {command}"
            opened.append(terminals.Terminal(command, tmp_path / "here", surroundings))
            problem = take(step, opened, tmp_path / "here")
            if problem:
                break
            if "closes" in step:
                ended = of_command(opened, step["closes"])
                opened.remove(ended)
                ended.close()
    finally:
        for terminal in reversed(opened):
            terminal.close()
    assert not problem, problem + "".join(
        f"\n\n--- {each.command}\n{each.shown[-1500:]}" for each in opened)
