"""Reads a launch file as roslaunch does, without starting anything."""

import multiprocessing
import os
import re
import signal
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from xml.etree.ElementTree import ParseError, parse

import roslaunch.config
import roslaunch.core
import roslaunch.loader
import roslaunch.substitution_args
import roslaunch.xmlloader
import rospkg
import yaml
from roslaunch.substitution_args import ArgException, SubstitutionException

from bullet_sim.errors import SimulationError, nearest_file
from bullet_sim.files import check_file
from bullet_sim.formats.resources import FindPackage
from bullet_sim.formats.xacro.bounds import limit_memory
from bullet_sim.formats.xacro.expressions import evaluate_substitution
from workspace_needs.check.parameter_commands import NotRun, output_of

ERRORS = (roslaunch.core.RLException, roslaunch.xmlloader.XmlParseException,
          SubstitutionException, rospkg.ResourceNotFound, yaml.YAMLError, OSError, ValueError,
          LookupError, SyntaxError, ArithmeticError, TypeError, NameError, RecursionError,
          MemoryError, SimulationError)
LONGEST = 3.0  # s of processor time to read a launch file, without the commands that it runs
LONGEST_WAIT = 30  # s, for all its commands
LARGEST_FILE = 32 * 2**20  # bytes of a parameter's file
LONGEST_LINE = 500  # characters of an error
TOO_MUCH = (f"to read it takes more than {LONGEST:g} s or 1 GiB; look at its $(eval …), and how "
            "many files it reads")
REPEATED = 20  # a file that is this often in the stack of includes includes itself
NOT_UTF8 = re.compile(r"'utf-8' codec can't decode .*?: "
                      "(?:invalid (?:start|continuation) byte|unexpected end of data)")
YAML_BLOCK = re.compile(r'Error within YAML block:.*?([^\n]+)\n +in "<unicode string>", '
                        r"line (\d+), column \d+:\n *([^\n]*)\n *\^\n\nYAML is:", re.DOTALL)
TOO_DEEP = re.compile(r"maximum recursion depth exceeded(?: (?:while|in) [a-z ]*Python object)?")
OF_A_TEXT = re.compile(r'\sin "<unicode string>",')  # PyYAML's name of what roslaunch has read
ON_THE_WAY = re.compile(r"^(while processing \S+: )+(?=while processing )")


@dataclass(frozen=True)
class LaunchedNode:
    """A `<node>` with everything substituted."""

    package: str
    type: str
    namespace: str
    args: str
    environ: tuple[tuple[str, str], ...] = ()  # of its <env>


@dataclass(frozen=True)
class Launch:
    """The nodes and parameters of a launch file."""

    nodes: tuple[LaunchedNode, ...]
    parameters: dict[str, object]  # by full name; NotRun for the output of an unknown command
    faults: tuple[str, ...] = ()  # of elements, for each of which roslaunch would end


def read_launch(path: Path, arguments: list[str], find_package: FindPackage,
                run_commands: bool = False) -> Launch:
    """Read a launch file as roslaunch does; SimulationError says in one line why it fails.

    An element that roslaunch would end for is one of the `faults`, and the others are read.
    Done in a process of its own: `$(eval …)` may take any time or memory, and commands may hang.
    They are run only with `run_commands`: else xacro and cat are done here, and others are NotRun.
    """
    output = None if run_commands else partial(output_of, find_package=find_package)
    receiver, sender = multiprocessing.Pipe(duplex=False)
    reader = multiprocessing.get_context("fork").Process(
        target=_read, args=(path, arguments, output, sender), daemon=False)
    reader.start()
    sender.close()
    running = ""
    try:
        while isinstance(result := receiver.recv(), _Running):
            running = result.command
        reader.join()
    except EOFError:
        reader.join()
        result = _why_ended(reader.exitcode, running)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(reader.pid, signal.SIGKILL)  # a command that hangs
    if isinstance(result, str):
        raise SimulationError(result)
    return result


@dataclass(frozen=True)
class _Running:
    """What the reader sends before and after a command."""

    command: str  # empty: none


def _why_ended(exit_code: int | None, command: str) -> str:
    if exit_code == -signal.SIGALRM and command:
        return (f"its command has not ended after {LONGEST_WAIT} s: {command[:LONGEST_LINE]}; "
                "does it wait for input?")
    if exit_code == -signal.SIGALRM:
        return f"to read it takes more than {LONGEST_WAIT} s; does one of its files not end?"
    return TOO_MUCH


def _read(path: Path, arguments: list[str], output: Callable[[str], str] | None,
          sender: Connection) -> None:
    os.setpgrp()  # so that its commands can be ended with it
    # Timers and not RLIMIT_CPU, which each command would inherit.
    for number in (signal.SIGPROF, signal.SIGALRM):
        signal.signal(number, signal.SIG_DFL)  # which ends the process, whatever the parent does
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    signal.alarm(LONGEST_WAIT)
    limit_memory()
    loader = roslaunch.loader.Loader
    loader.param_value = _remembered(loader.param_value, output, sender)
    roslaunch.substitution_args.eval = _evaluate
    faults = _watch(roslaunch.xmlloader.XmlLoader)
    try:
        config = roslaunch.config.load_config_default(
            [(str(path), arguments)], None, verbose=False, assign_machines=False)
    except ERRORS as error:
        sender.send(_error_line(error))
        return
    sender.send(Launch(
        tuple(LaunchedNode(node.package, node.type, node.namespace, node.args,
                           tuple(node.env_args))
              for node in config.nodes),
        {name: parameter.value for name, parameter in config.params.items()},
        tuple(dict.fromkeys(faults))))


def _evaluate(expression: str, symbols: dict, local: Mapping) -> object:
    """As evaluate_substitution; each error has a text, which roslaunch puts into its own."""
    try:
        return evaluate_substitution(expression, symbols, local)
    except Exception as error:
        if str(error):
            raise
        raise SimulationError(_error_line(error)) from error


def _error_line(error: Exception) -> str:
    """roslaunch's message as one line, without the files that include the faulty one."""
    if isinstance(error, MemoryError):
        return TOO_MUCH
    if isinstance(error, rospkg.ResourceNotFound):
        return (f"no package {error.args[0]} is found: source the devel/setup.bash of its "
                "workspace first")
    if isinstance(error, ArgException):
        return f"no <arg name=\"{error}\"> stands before $(arg {error}); mend the name"
    if block := YAML_BLOCK.search(str(error)):
        return f"YAML in <rosparam>: {block[1]}; line {block[2]} of it: {block[3]}"
    text = " ".join(str(error).split()) or type(error).__name__
    text = OF_A_TEXT.sub(" at", ON_THE_WAY.sub("", text))
    text = NOT_UTF8.sub("it is not UTF-8; save it as UTF-8", text)
    text = TOO_DEEP.sub("elements are nested too deep", text)
    return text if len(text) <= LONGEST_LINE else f"{text[:LONGEST_LINE]} …"


class _Endless(SimulationError):
    """Files include each other without end."""


def _watch(loader: type) -> list[str]:
    """Make roslaunch's reader go on behind a faulty element; the list that its faults will be in.

    It ends where files include each other without end.
    """
    parse_launch = loader._parse_launch
    files: list[str] = []
    faults: list[str] = []

    def parse_and_count(self, filename, verbose):
        files.append(filename)
        if files.count(filename) > REPEATED:
            way = f" by way of {files[-2]}" if files[-2] != filename else ""
            raise _Endless(f"{filename} includes itself{way} without end; remove "
                           "the <include> or give it an if")
        if len(files) > 2 and not Path(filename).exists():
            raise SimulationError(f"<include>: there is no file {filename}"
                                  f"{nearest_file(filename)}")
        return parse_launch(self, filename, verbose)

    def going_on(read):
        def element(*arguments, **named):
            depth = len(files)
            try:
                return read(*arguments, **named)
            except _Endless:
                raise
            except ERRORS as error:
                # The first two are roslaunch's own file and the one that is checked.
                within = f"while processing {files[depth - 1]}: " if depth > 2 else ""
                faults.append(within + _error_line(error))
            finally:
                del files[depth:]
        return element

    loader._parse_launch = parse_and_count
    for name in ("_include_tag", "_node_tag", "_param_tag", "_rosparam_tag"):
        setattr(loader, name, going_on(getattr(loader, name)))
    return faults


def _remembered(param_value: Callable, output: Callable[[str], str] | None,
                sender: Connection) -> Callable:
    """roslaunch's function with a cache: each file is read, and each command run, only once.

    `output` returns what a command prints; None: the command is run.
    """
    values: dict[tuple, object] = {}

    def remembered(loader, verbose, name, ptype, value, textfile, binfile, command):
        what = (ptype, textfile, binfile, command)
        if value is not None:
            return param_value(loader, verbose, name, ptype, value, None, None, None)
        if what not in values:
            if file := textfile or binfile:
                check_file(file, LARGEST_FILE)
            if command and output is not None:
                text = output(command)
                values[what] = (text if isinstance(text, NotRun) else
                                roslaunch.loader.convert_value(text, ptype))
                return values[what]
            sender.send(_Running(command or ""))
            values[what] = param_value(loader, verbose, name, ptype, None, *what[1:])
            sender.send(_Running(""))
        return values[what]

    return remembered


def missing_arguments(path: Path, given: Collection[str]) -> list[str]:
    """The names of each `<arg>` without a value; `given` are words NAME:=VALUE."""
    try:
        root = parse(path).getroot()
    except (ParseError, OSError, LookupError, ValueError):  # of files and of their encodings
        return []  # roslaunch says why
    names = {word.split(":=", 1)[0] for word in given}
    return [name for arg in root.findall("arg") if (name := arg.get("name"))
            and not {"default", "value", "if", "unless"}.intersection(arg.keys())
            and name not in names]
