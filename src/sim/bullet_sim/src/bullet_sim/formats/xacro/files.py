"""Expands xacro files with PyPI's xacro, and old ones as in the releases they were written for."""

import logging
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro.bounds import TooLarge
from bullet_sim.formats.xacro.expansion import Attempt, FindPackage, Run, attempt
from bullet_sim.formats.xacro.older_releases import Legacy, Melodic

_LOCK = threading.Lock()  # xacro keeps its state in module variables: one expansion at a time
_LOGGER = logging.getLogger(__name__)


@dataclass(frozen=True)
class Expansion:
    """The result of expanding a file."""

    text: str  # the XML document
    files: tuple[str, ...]  # other files that it read, in order


def expand(
    path: str | Path,
    mappings: Mapping[str, str] | None = None,
    find_package: FindPackage | None = None,
) -> str:
    """The XML text of a xacro file; `mappings` are its arguments, `find_package` its $(find …)."""
    return expand_file(path, mappings, find_package).text


def expand_file(
    path: str | Path,
    mappings: Mapping[str, str] | None = None,
    find_package: FindPackage | None = None,
) -> Expansion:
    """As `expand`, and the other files involved; FormatError names file, place and reason.

    The file is first read strictly. If that fails or leaves tags that URDF does not know, the file
    may be old: macros and keywords then also count without prefix (Melodic), and if that fails,
    macros and properties also before their definition (Indigo to Lunar). Such a result is kept if
    no two links and no two joints have the same name.
    """
    run = Run(str(path), dict(mappings or {}), find_package)
    with _LOCK:
        chosen = _choose(run)
    for level, text in chosen.messages:
        _LOGGER.log(level, "%s", text)
    return Expansion(chosen.text(), chosen.files)


def _choose(run: Run) -> Attempt:
    """The strict reading, or an older one if that is better; see `expand_file`."""
    strict, problem = None, None
    try:
        strict = attempt(run, {})
        if not strict.unknown_tags():
            return strict
    except TooLarge:
        raise
    except FormatError as error:
        problem = error

    melodic = Melodic()
    try:
        loose = attempt(run, melodic.replacements())
        if melodic.used and loose.has_unique_names():
            return _with_hint(loose, run.path)
    except FormatError as error:
        if problem and melodic.used:  # an old file: the strict reading lacked prefixes
            problem = error
    if strict is not None:
        return _with_hint(strict, run.path)
    return _with_hint(_legacy(run, problem), run.path)


def _legacy(run: Run, problem: FormatError) -> Attempt:
    """The order of the oldest releases; raises `problem` if that does not help."""
    legacy = Legacy()
    try:
        found = attempt(run, legacy.replacements())
    except FormatError:
        raise problem from None
    if not (legacy.used and found.has_unique_names()):
        raise problem
    found.messages.append((logging.WARNING, f"{problem}; read in the order of releases before "
                                            "Melodic, define things before they are used"))
    return found


def _with_hint(chosen: Attempt, path: str) -> Attempt:
    """The same, with a warning if something was perhaps meant as a macro."""
    if tags := dict.fromkeys(chosen.unknown_tags()):
        names = ", ".join(f"<{tag}>" for tag in tags)
        hint = f"{path}: {names} left as it is: no macro and no tag of URDF or SRDF"
        chosen.messages.append((logging.WARNING, hint))
    return chosen
