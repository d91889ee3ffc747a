"""Checks launch files without starting anything: their nodes, worlds and robots."""

from __future__ import annotations

import itertools
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
          KeyError)


class LaunchChecker:
    """One launch file at a time."""

    def __init__(self, texts: TextChecker, resources: Resources):
        self._texts = texts
        self._resources = resources

    def launch_file(self, path: Path, arguments: list[str]) -> list[Finding]:
        """Nodes that cannot be found, and what its simulator and its spawners will load."""
        where = str(path)
        try:
            config = roslaunch.config.load_config_default(
                [(str(path), arguments)], None, verbose=False, assign_machines=False)
        except ERRORS as error:
            return [problem(where, "launch file", error)]
        found = [Finding(where, f"launch file ({len(config.nodes)} nodes)", WORKS)]
        for node in config.nodes:
            found += self._node(node, config, where)
        return found

    def _node(self, node: roslaunch.core.Node, config, where: str) -> Iterator[Finding]:
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
            yield from self._spawned(words, node, config, where)

    def _world(self, words: list[str], where: str) -> list[Finding]:
        values = [word for word in words if not word.startswith("-") and ":=" not in word]
        name = values[-1] if values and values[-1].endswith((".world", ".sdf")) else None
        if name is None:
            return []
        try:
            return self._texts.world_file(self._resources.find_world(name))
        except SimulationError as error:
            return [problem(where, f"world {name}", error)]

    def _spawned(self, words: list[str], node, config, where: str) -> list[Finding]:
        options = dict(itertools.pairwise(words))
        if "-file" in options:
            return self._texts.model_file(Path(options["-file"]), {})
        if "-database" in options:
            uri = f"model://{options['-database']}"
            text = (f'<sdf version="1.4"><world name="w"><include><uri>{uri}</uri></include>'
                    "</world></sdf>")
            return self._texts.model_text(text, uri)
        if "-param" in options:
            return self._parameter(options["-param"], node, config, where)
        return []

    def _parameter(self, name: str, node, config, where: str) -> list[Finding]:
        full = name if name.startswith("/") else f"{node.namespace}{name}"
        for candidate in (full, "/" + name.lstrip("/")):
            if candidate in config.params:
                return self._texts.model_text(str(config.params[candidate].value),
                                              f"{where}, parameter {candidate}")
        return [problem(where, f"spawn_model -param {name}",
                        f"no parameter {full}; a <param name=\"{name}\"> has to stand before it")]
