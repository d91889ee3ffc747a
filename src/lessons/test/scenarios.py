"""The scenarios of lesson_commands.yaml, with scripts and with C++ programs, and how one runs."""

from __future__ import annotations

import importlib.util
import os
import re
from contextlib import suppress
from pathlib import Path
from xmlrpc.client import ServerProxy

import yaml

HERE = Path(__file__).resolve().parent
LESSONS = HERE.parent
SCENARIOS = yaml.safe_load((HERE / "lesson_commands.yaml").read_text(encoding="utf-8"))
ELSEWHERE = SCENARIOS.pop("tested elsewhere")
# Packages whose scenarios start the simulator: tested in a file of their own, beside the others.
SIMULATED = {"ai_robot_tracking", "lane_keeping", "learning_autorace", "learning_laser", "nav_demo",
             "urdf02_gazebo"}
PROGRAM = re.compile(r"\brosrun (learning_\w+|actionlib_tutorials) (\w+)\.py")
LAUNCHED = re.compile(r"\broslaunch (learning_\w+) (\w+\.launch)")

_spec = importlib.util.spec_from_file_location("terminals", HERE / "terminals.py")
terminals = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(terminals)


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


def twins() -> dict[str, list[dict]]:
    """Package -> its scenarios in C++, each up to the last step that names a C++ program.

    A scenario is left out whose C++ programs earlier ones have started.
    """
    found: dict[str, list[dict]] = {}
    started: set[str] = set()
    for package, scenarios in SCENARIOS.items():
        for scenario in scenarios:
            scripts, steps = scenario["terminals"], in_cpp(scenario["terminals"])
            changed = [number for number, step in enumerate(steps) if step != scripts[number]]
            new = {steps[number]["type"] for number in changed} - started
            if new - {script["type"] for script in scripts}:
                started |= new
                found.setdefault(package, []).append(
                    {"name": scenario["name"], "terminals": steps[:changed[-1] + 1]})
    return found


def environment(folder: Path, port: int) -> dict[str, str]:
    """A terminal's on a machine without a screen, with a master of its own."""
    own = {"ROS_MASTER_URI": f"http://localhost:{port}", "ROS_HOSTNAME": "localhost",
           "ROS_HOME": str(folder / "ros"), "ROS_LOG_DIR": str(folder / "ros")}
    dropped = {"DISPLAY", "PYTHONUNBUFFERED", "ROS_IP"}
    return {name: value for name, value in os.environ.items() if name not in dropped} | own


def of_command(opened: list, command: str):
    """The newest terminal with this command."""
    return next(terminal for terminal in reversed(opened) if terminal.command == command)


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


class Roscore:
    """The one of all scenarios that type it: it takes longer to start than most of them to run.

    Only topics' types remain of the scenarios before, which no master forgets.
    """

    def __init__(self, folder: Path):
        self._folder, self._terminal, self._port = folder, None, 0

    def cleared(self) -> int:
        """Its port, once it has nothing of a scenario before; a killed node brings a new one."""
        if self._terminal is None or not self._clear():
            self.close()
            self._port = terminals.free_port()
            # Alone it takes no notice of ROS_MASTER_URI's port.
            self._terminal = terminals.Terminal(f"roscore -p {self._port}", self._folder,
                                                environment(self._folder, self._port))
            problem = self._terminal.wait_until_shown("started core service")
            assert not problem, problem
        return self._port

    def _clear(self) -> bool:
        """Deletes parameters that are not its own; whether no node but its own is registered."""
        with suppress(OSError), ServerProxy(f"http://localhost:{self._port}") as master:
            names = {name.split("/")[1] for name in master.getParamNames("/test")[2]}
            for name in names - {"rosdistro", "roslaunch", "rosversion", "run_id"}:
                master.deleteParam("/test", f"/{name}")
            state = master.getSystemState("/test")[2]
            return {node for kind in state for _, nodes in kind for node in nodes} <= {"/rosout"}
        return False  # it has ended

    def close(self) -> None:
        if self._terminal:
            self._terminal.close()


def run(scenario: dict, folder: Path, roscore: Roscore | None = None) -> str | None:
    """Types a scenario's commands in an empty folder; what went wrong, or None."""
    steps = [step for step in scenario["terminals"] if step["type"] != "roscore"]
    typed = len(steps) < len(scenario["terminals"])
    port, opened, problem = roscore.cleared() if typed else terminals.free_port(), [], None
    surroundings = environment(folder, port)
    (folder / "here").mkdir()
    try:
        for step in steps:
            command = f"cd {step['in']} && {step['type']}" if "in" in step else step["type"]
            opened.append(terminals.Terminal(command, folder / "here", surroundings))
            problem = take(step, opened, folder / "here")
            if problem:
                break
            if "closes" in step:
                ended = of_command(opened, step["closes"])
                opened.remove(ended)
                ended.close()
    finally:
        for terminal in reversed(opened):
            terminal.close()
    return problem and problem + "".join(
        f"\n\n--- {each.command}\n{each.shown[-1500:]}" for each in opened)
