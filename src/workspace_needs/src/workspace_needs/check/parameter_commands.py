"""The output of a `<param>`'s `command`, without running it: xacro and cat are done here."""

import resource
import shlex
import tempfile
from collections.abc import Sequence
from pathlib import Path

from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats.resources import FindPackage
from bullet_sim.formats.xacro.bounds import MOST_SECONDS, run_bounded
from bullet_sim.formats.xacro.files import expand_file
from bullet_sim.formats.xml_text import decoded, read_bytes
from workspace_needs.check.dry_run import listening

XACRO = ("xacro", "xacro.py")
LAUNCHERS = (["rosrun", "xacro"], ["python"], ["python2"], ["python3"])
WITHOUT_EFFECT = frozenset(["--inorder", "-i", "--legacy", "--check-order", "--includes",
                            "--xacro-ns", "-q", "-v"])
MOST_IN_SUM = 60.0  # s of processor time for all xacro files of one that is checked
_taken: list[float] = []  # s of it, by files; in a process that checks one file
OF_ROSLAUNCH = "rosversion"  # in roslaunch's own roscore.xml; it changes nothing
OF_EMPTY_WORLD = "unless_running"  # prints its arguments


class NotRun(str):
    """Stands for the output of a command that is not run."""

    __slots__ = ()


def output_of(command: str, find_package: FindPackage) -> str:
    """What a command would print; NotRun if it is neither xacro nor cat.

    FormatError if a file cannot be read or expanded.
    """
    try:
        program, *words = _without_launcher(shlex.split(command))
    except ValueError:
        return NotRun(command)
    program = Path(program).name
    if program == OF_ROSLAUNCH:
        return ""
    if program == OF_EMPTY_WORLD:
        return " ".join(words)
    if program == "cat" and words and not any(word.startswith("-") for word in words):
        return "".join(decoded(read_bytes(Path(word))) for word in words)
    words = [word for word in words if word not in WITHOUT_EFFECT]
    files = [word for word in words if ":=" not in word]
    if program in XACRO and len(files) == 1 and not files[0].startswith("-"):
        mappings = dict(word.split(":=", 1) for word in words if ":=" in word)
        return expanded(Path(files[0]), mappings, find_package)
    return NotRun(command)


def expanded(path: Path, mappings: dict[str, str], find_package: FindPackage) -> str:
    """The URDF of a xacro file; time and memory are limited, as expressions may take any amount.

    FormatError if the file cannot be expanded, or those before it took MOST_IN_SUM.
    """
    left = MOST_IN_SUM - sum(_taken)
    if left <= 0.0:
        raise FormatError(f"{path}: it is not expanded: those before it took {MOST_IN_SUM:g} s of "
                          "processor time")
    with tempfile.TemporaryDirectory(prefix="check-") as folder:
        result = Path(folder) / "result"

        def expand_into_file() -> int:
            code = 0
            try:
                text = expand_file(path, mappings, find_package).text
            except SimulationError as error:
                text, code = str(error), 1
            result.write_text(text, encoding="utf-8")
            return code

        before = _time_of_children()
        try:
            with listening():
                code = run_bounded(expand_into_file, str(path), min(MOST_SECONDS, left))
        finally:
            _taken.append(_time_of_children() - before)
        output = result.read_text(encoding="utf-8") if result.exists() else "it failed"
    if code:
        raise FormatError(output)
    return output


def _time_of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _without_launcher(words: Sequence[str]) -> Sequence[str]:
    """The words from xacro's name on, if rosrun or Python start it."""
    for launcher in LAUNCHERS:
        after = words[len(launcher):]
        if [Path(words[0]).name, *words[1:len(launcher)]] == launcher and after and (
                Path(after[0]).name in XACRO):
            return after
    return words
