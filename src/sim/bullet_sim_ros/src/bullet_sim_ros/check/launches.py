"""Checks launch files without starting anything: their nodes, worlds and robots."""

from __future__ import annotations

import itertools
import multiprocessing
import resource
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TYPE_CHECKING

import roslaunch.config
import roslaunch.core
import roslaunch.xmlloader
import roslib.packages
import rospkg
import yaml
from roslaunch.substitution_args import SubstitutionException

from bullet_sim.errors import SimulationError
from bullet_sim.formats import Resources
from bullet_sim_ros.check.elements import problem
from bullet_sim_ros.check.findings import ABSENT, WORKS, Finding
from bullet_sim_ros.check.texts import TextChecker

if TYPE_CHECKING:
    from collections.abc import Iterator

SPAWNERS = ("spawn_model", "spawn_model.py", "spawn_urdf")
SERVERS = ("gzserver", "gazebo", "debug")
ERRORS = (roslaunch.core.RLException, roslaunch.xmlloader.XmlParseException,
          SubstitutionException, rospkg.ResourceNotFound, yaml.YAMLError, OSError, ValueError,
          KeyError, SyntaxError, ArithmeticError, TypeError, NameError, RecursionError, MemoryError)
LONGEST = 2  # s of processor time to read a launch file, without the commands that it runs
MOST_MEMORY = 1 << 30  # bytes
LONGEST_LINE = 500  # characters of an error


@dataclass(frozen=True)
class LaunchedNode:
    """A `<node>` with everything substituted."""

    package: str
    type: str
    namespace: str
    args: str


@dataclass(frozen=True)
class Launch:
    """What a launch file comes to."""

    nodes: tuple[LaunchedNode, ...]
    parameters: dict[str, str]  # by full name


def read_launch(path: Path, arguments: list[str]) -> Launch:
    """As roslaunch reads it; SimulationError says in one line why it cannot.

    In a process of its own: `$(eval …)` may want any time or memory.
    """
    receiver, sender = multiprocessing.Pipe(duplex=False)
    reader = multiprocessing.get_context("fork").Process(
        target=_read, args=(path, arguments, sender), daemon=False)
    reader.start()
    sender.close()
    try:
        result = receiver.recv()
    except EOFError:
        result = f"to read it takes more than {LONGEST} s or 1 GiB; look at its $(eval …)"
    reader.join()
    if isinstance(result, str):
        raise SimulationError(result)
    return result


def _read(path: Path, arguments: list[str], sender: Connection) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST + 1))
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))
    try:
        config = roslaunch.config.load_config_default(
            [(str(path), arguments)], None, verbose=False, assign_machines=False)
    except ERRORS as error:
        sender.send(" ".join(str(error).split())[:LONGEST_LINE] or type(error).__name__)
        return
    sender.send(Launch(
        tuple(LaunchedNode(node.package, node.type, node.namespace, node.args)
              for node in config.nodes),
        {name: str(parameter.value) for name, parameter in config.params.items()}))


class LaunchChecker:
    """One launch file at a time."""

    def __init__(self, texts: TextChecker, resources: Resources):
        self._texts = texts
        self._resources = resources

    def launch_file(self, path: Path, arguments: list[str]) -> list[Finding]:
        """Nodes that cannot be found, and what its simulator and its spawners will load."""
        where = str(path)
        try:
            launch = read_launch(path, arguments)
        except SimulationError as error:
            return [problem(where, "launch file", error)]
        found = [Finding(where, f"launch file ({len(launch.nodes)} nodes)", WORKS)]
        for node in launch.nodes:
            found += self._node(node, launch, where)
        return found

    def _node(self, node: LaunchedNode, launch: Launch, where: str) -> Iterator[Finding]:
        name = f"node {node.package}/{node.type}"
        try:
            if not roslib.packages.find_node(node.package, node.type):
                yield Finding(where, name, ABSENT, f"package {node.package} has no executable "
                              f"{node.type} here")
                return
        except rospkg.ResourceNotFound:
            yield Finding(where, name, ABSENT, f"package {node.package} is not here; clone it into "
                          "src/ if it is your own, else see the README's list")
            return
        yield Finding(where, name, WORKS)
        words = node.args.split()
        if node.package == "gazebo_ros" and node.type in SERVERS:
            yield from self._world(words, where)
        elif node.package == "gazebo_ros" and node.type in SPAWNERS:
            yield from self._spawned(words, node, launch, where)

    def _world(self, words: list[str], where: str) -> list[Finding]:
        values = [word for word in words if not word.startswith("-") and ":=" not in word]
        name = values[-1] if values and values[-1].endswith((".world", ".sdf")) else None
        if name is None:
            return []
        try:
            return self._texts.world_file(self._resources.find_world(name))
        except SimulationError as error:
            return [problem(where, f"world {name}", error)]

    def _spawned(self, words: list[str], node: LaunchedNode, launch: Launch,
                 where: str) -> list[Finding]:
        options = dict(itertools.pairwise(words))
        if "-file" in options:
            return self._texts.model_file(Path(options["-file"]), {})
        if "-database" in options:
            uri = f"model://{options['-database']}"
            text = (f'<sdf version="1.4"><world name="w"><include><uri>{uri}</uri></include>'
                    "</world></sdf>")
            return self._texts.model_text(text, uri)
        if "-param" in options:
            return self._parameter(options["-param"], node, launch, where)
        return []

    def _parameter(self, name: str, node: LaunchedNode, launch: Launch,
                   where: str) -> list[Finding]:
        full = name if name.startswith("/") else f"{node.namespace}{name}"
        for candidate in (full, "/" + name.lstrip("/")):
            if candidate in launch.parameters:
                return self._texts.model_text(launch.parameters[candidate],
                                              f"{where}, parameter {candidate}")
        return [problem(where, f"spawn_model -param {name}",
                        f"no parameter {full}; a <param name=\"{name}\"> has to stand before it")]
