"""Checks launch files without starting anything: their nodes, worlds and robots."""

from __future__ import annotations

import itertools
import os
import re
import shlex
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from types import MappingProxyType

import roslib.packages
import rospkg
import yaml

from bullet_sim.errors import SimulationError, did_you_mean
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xml_text import decoded, read_bytes
from bullet_sim_ros.control import controllers, registry  # noqa: F401  (controllers register)
from bullet_sim_ros.interface import Row
from bullet_sim_ros.package_paths import open_resources
from workspace_needs.check.findings import ABSENT, PROBLEM, UNCHECKED, WORKS, Finding, problem, told
from workspace_needs.check.launch_files import (
    Launch,
    LaunchedNode,
    missing_arguments,
    read_launch,
)
from workspace_needs.check.parameter_commands import XACRO, NotRun
from workspace_needs.check.sources import script_findings
from workspace_needs.check.texts import TextChecker
from workspace_needs.tables import why_absent

SPAWNERS = ("spawn_model", "spawn_model.py", "spawn_urdf")
SERVERS = ("gzserver", "gazebo", "debug")
OF_OPENCV = "%YAML:"  # no YAML: what cv::FileStorage writes
Unbuilt = Mapping[str, Collection[str] | None]  # names of programs by package; None: unknown
NONE_UNBUILT: Unbuilt = MappingProxyType({})
SEARCH_PATHS = ("GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH")
LARGEST_SCRIPT = 2**20  # bytes
CALLS_XACRO = re.compile(rb"\bxacro(\.py)?[\s\"',)]|\bxacro\.process_file|import xacro\b")


def _executables(package: str) -> set[str]:
    """Names of what `rosrun` starts of a package."""
    folders = [Path(folder) for folder in roslib.packages.catkin_find(
        project=package, search_dirs=["libexec", "share"])]
    return {path.name for folder in folders for path in folder.rglob("*")
            if path.is_file() and os.access(path, os.X_OK)}


def _words(node: LaunchedNode) -> list[str]:
    """Its arguments, split as by roslaunch; at spaces alone if a quotation mark is not closed."""
    try:
        return shlex.split(node.args)
    except ValueError:
        return node.args.split()


def _is_server(node: LaunchedNode) -> bool:
    return node.package == "gazebo_ros" and node.type in SERVERS


@cache
def _runs_xacro(file: str) -> bool:
    """Whether it is a script that names xacro and a .xacro file, other than xacro itself."""
    path = Path(file)
    if path.name in XACRO or not path.is_file() or path.stat().st_size > LARGEST_SCRIPT:
        return False
    text = path.read_bytes()
    return text.startswith(b"#!") and CALLS_XACRO.search(text) is not None


class LaunchChecker:
    """Checks one launch file at a time.

    `unbuilt`: packages that may not be built yet, and the programs that their build makes.
    """

    def __init__(self, rows: dict[str, Row], texts: TextChecker, resources: Resources,
                 run_commands: bool, environ: Mapping[str, str] = os.environ,
                 unbuilt: Unbuilt = NONE_UNBUILT):
        self._rows = rows
        self._environ = environ
        self._unbuilt = unbuilt
        self._run_commands = run_commands
        self._texts = texts
        self._resources = resources
        # It lists all packages, when it is first asked.
        self._packages = rospkg.RosPack(rospkg.get_ros_paths(environ))
        self._find_node = cache(  # which looks through a whole package
            partial(roslib.packages.find_node, rospack=self._packages))

    def launch_file(self, path: Path, arguments: list[str], alone: bool = True) -> list[Finding]:
        """Findings about its nodes, and about what its simulator and its spawners will load.

        A file that needs arguments may be included by others, unless the user named it (`alone`).
        """
        where = str(path)
        if missing := missing_arguments(path, arguments):
            words = " ".join(f"{name}:=…" for name in missing)
            return [Finding(where, "launch file", PROBLEM if alone else UNCHECKED,
                            f"it needs {words}; rosrun bullet_sim_ros check {path} {words}")]
        try:
            launch = read_launch(path, arguments, self._texts.find_package, self._run_commands)
        except SimulationError as error:
            return [problem(where, "launch file", error)]
        found = [problem(where, "launch file", fault) for fault in launch.faults] or [
            Finding(where, f"launch file ({len(launch.nodes)} nodes)", WORKS)]
        found += [Finding(where, f"parameter {name}", UNCHECKED,
                          f"its command is not run: {value}; --run-commands runs it")
                  for name, value in launch.parameters.items() if isinstance(value, NotRun)]
        server = self._with_environment(launch)
        for node in launch.nodes:
            found += server._node(node, launch, where)
        spawned = {word for node in launch.nodes if node.package == "controller_manager"
                   for word in _words(node)}
        return [*found, *controller_findings(launch.parameters, spawned, self._rows, where)]

    def yaml_file(self, path: Path) -> list[Finding]:
        """Findings about a file that some launch file may load: its syntax, and its controllers."""
        where = str(path)
        try:
            text = decoded(read_bytes(path))
            if text.startswith(OF_OPENCV):
                return []
            list(yaml.compose_all(text, yaml.SafeLoader))  # tags may be anybody's own
        except yaml.MarkedYAMLError as error:
            line, column = error.problem_mark.line + 1, error.problem_mark.column + 1
            return [problem(where, "YAML", f"line {line}, column {column}: {error.problem}")]
        except (SimulationError, yaml.YAMLError) as error:
            return [problem(where, "YAML", error)]
        except RecursionError:
            return [problem(where, "YAML", "it is nested too deeply")]
        with suppress(yaml.YAMLError):
            content = yaml.safe_load(text)
            try:
                found = dict(_flat(content, "/")) if isinstance(content, dict) else {}
            except RecursionError:
                return [problem(where, "YAML", "an alias (*) stands within its own anchor (&)")]
            return list(controller_findings(found, (), self._rows, where))
        return []

    def _with_environment(self, launch: Launch) -> LaunchChecker:
        """This one with the search paths that the launch file gives its simulator by <env>."""
        written = {name: value for node in launch.nodes if _is_server(node)
                   for name, value in node.environ if name in SEARCH_PATHS}
        if not written:
            return self
        environ = {**self._environ, **written}
        resources = open_resources(environ)
        return LaunchChecker(self._rows, self._texts.with_resources(resources), resources,
                             self._run_commands, environ, self._unbuilt)

    def _node(self, node: LaunchedNode, launch: Launch, where: str) -> Iterator[Finding]:
        name = f"node {node.package}/{node.type}"
        try:
            files = self._find_node(node.package, node.type)
            if not files:
                yield self._not_there(node, where, name)
                return
        except rospkg.ResourceNotFound:
            why = why_absent(node.package, self._packages.list())
            yield Finding(where, name, ABSENT, f"package {node.package} is not here: {why}")
            return
        yield from list(script_findings(Path(files[0]))) or [Finding(where, name, WORKS)]
        words = _words(node)
        if _runs_xacro(files[0]):
            yield Finding(where, name, UNCHECKED, f"{files[0]} runs xacro; the robot that it makes "
                          "is not read: check its .xacro file")
        if _is_server(node):
            yield from self._world(words, launch, where)
        elif node.package == "gazebo_ros" and node.type in SPAWNERS:
            yield from self._spawned(words, node, launch, where)

    def _not_there(self, node: LaunchedNode, where: str, name: str) -> Finding:
        """A finding about a program that its package has not, or not before it is built."""
        programs = self._unbuilt.get(node.package, ())
        if programs is None:
            return Finding(where, name, UNCHECKED, "what the build makes of package "
                           f"{node.package} is not known: see what stands at that package")
        if node.type in programs:
            return Finding(where, name, WORKS, "once the workspace is built")
        near = did_you_mean(node.type, {*_executables(node.package), *programs}, 0.75)
        return Finding(where, name, ABSENT,
                       f"package {node.package} has no executable {node.type} here{near}")

    def _world(self, words: list[str], launch: Launch, where: str) -> list[Finding]:
        values = [word for word in words if not word.startswith("-") and ":=" not in word]
        name = values[-1] if values and values[-1].endswith((".world", ".sdf")) else None
        if name is None:
            return []
        try:
            return self._texts.world_file(self._resources.find_world(name), launch.parameters)
        except SimulationError as error:
            return [problem(where, f"world {name}", error)]

    def _spawned(self, words: list[str], node: LaunchedNode, launch: Launch,
                 where: str) -> list[Finding]:
        options = dict(itertools.pairwise(words))
        namespace = options.get("-robot_namespace", node.namespace)
        if "-file" in options:
            path = Path(options["-file"])
            try:
                text = decoded(read_bytes(path))
            except SimulationError as error:
                return [problem(str(path), "robot", error)]
            return self._texts.model_text(text, str(path), launch.parameters, namespace)
        if "-database" in options:
            uri = f"model://{options['-database']}"
            text = (f'<sdf version="1.4"><world name="w"><include><uri>{uri}</uri></include>'
                    "</world></sdf>")
            return self._texts.model_text(text, uri, launch.parameters, namespace)
        if "-param" in options:
            return self._parameter(options["-param"], node, namespace, launch, where)
        return []

    def _parameter(self, name: str, node: LaunchedNode, namespace: str, launch: Launch,
                   where: str) -> list[Finding]:
        full = name if name.startswith("/") else f"{node.namespace}{name}"
        for candidate in (full, "/" + name.lstrip("/")):
            if candidate in launch.parameters:
                value = launch.parameters[candidate]
                if isinstance(value, NotRun):
                    return []
                return self._texts.model_text(
                    str(value), f"{where}, parameter {candidate}",
                    launch.parameters, namespace)
        if launch.faults:  # of the element that sets it, perhaps
            return []
        return [problem(where, f"spawn_model -param {name}",
                        f"no parameter {full}; a <param name=\"{name}\"> has to stand before it")]


def _flat(tree: dict, path: str) -> Iterator[tuple[str, object]]:
    """Parameters by full name, and their values."""
    for name, value in tree.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{path}{name}/")
        else:
            yield f"{path}{name}", value


KIND = re.compile(r"\w+/\w+")
PACKAGE = re.compile(r"\w*controllers?(_\w+)?/")


def controller_findings(parameters: Mapping[str, object], spawned: Collection[str],
                        rows: Mapping[str, Row], where: str) -> Iterator[Finding]:
    """A finding for each controller.

    Other parameters are called `type` as well. If the type's package is not named after
    controllers, it only counts if a spawner was given the controller's name, one of `spawned`.
    """
    known = rows["controllers"].tags
    for name, kind in parameters.items():
        namespace, _, last = name.rpartition("/")
        if last != "type" or not isinstance(kind, str) or not KIND.fullmatch(kind):
            continue
        part = f"controller {namespace} ({kind})"
        if registry.find(kind) is not None:
            row = known.get(kind)
            yield Finding(where, part, row.status if row else WORKS, told(row) if row else "")
        elif PACKAGE.match(kind) or namespace.rpartition("/")[2] in spawned:
            yield Finding(where, part, ABSENT,
                          f"there is no such type of controller here{registry.hint(kind)}")
