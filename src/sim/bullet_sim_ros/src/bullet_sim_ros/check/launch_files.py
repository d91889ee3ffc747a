"""Reads a launch file as roslaunch does, without starting anything."""

from __future__ import annotations

import multiprocessing
import resource
from collections.abc import Collection
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from xml.etree.ElementTree import ParseError, parse

import roslaunch.config
import roslaunch.core
import roslaunch.xmlloader
import rospkg
import yaml
from roslaunch.substitution_args import SubstitutionException

from bullet_sim.errors import SimulationError

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
    parameters: dict[str, object]  # by full name


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
        {name: parameter.value for name, parameter in config.params.items()}))


def missing_arguments(path: Path, given: Collection[str]) -> list[str]:
    """The names of those `<arg>` that have no value; `given` are words NAME:=VALUE."""
    try:
        root = parse(path).getroot()
    except (ParseError, OSError):
        return []  # roslaunch says why
    names = {word.split(":=", 1)[0] for word in given}
    return [arg.get("name", "") for arg in root.findall("arg")
            if not {"default", "value", "if", "unless"}.intersection(arg.keys())
            and arg.get("name") not in names]
