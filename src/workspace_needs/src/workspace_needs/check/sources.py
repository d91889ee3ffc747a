"""A package's own programs: its scripts, and image transports of C++ nodes."""

import ast
import math
import os
import re
import shlex
import shutil
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import rospkg

from workspace_needs.check.findings import (
    ABSENT,
    HINT,
    PROBLEM,
    SERIOUS,
    UNCHECKED,
    WORKS,
    Finding,
    problem,
)
from workspace_needs.check.modules import walk
from workspace_needs.check.packages import (
    BYTE_ORDER_MARK,
    FOR_ROSRUN,
    Package,
    first_line,
    has_interpreter,
    is_python,
)
from workspace_needs.check.python_files import Script, python_findings, read_script
from workspace_needs.workspace import SOURCES

FILE_NAME = re.compile("[^{}$%]+")  # without those of templates, such as {{name}}.py
HOLDS_PYTHON = (ast.Import, ast.ImportFrom, ast.FunctionDef)
FIRST = "line 1"
PYTHON = "#!/usr/bin/env python3"
# With bounds, so that the time is linear.
HINTS = re.compile(rb"\bTransportHints\b[^;\n\"]{0,200}\(\s{0,200}\"(\w+)\"")
TRANSPORTS = {"compressed": "compressed_image_transport", "theora": "theora_image_transport",
              "compressedDepth": "compressed_depth_image_transport"}
LARGEST = 1 << 20  # bytes of a source that is searched
SILENT = "silent"  # the status of faults in what perhaps nobody starts or imports


def program_findings(folder: Path, until: float = math.inf, where: str = "",
                     source: Path | None = None) -> Iterator[Finding]:
    """Findings about programs below `folder` that will not start, or end with an exception.

    Also about modules that others import; if all are fine, one with their number. `until`: a time
    of time.monotonic(). `where`: that of the package. `source`: the src/ of its workspace.
    """
    package, number, fine = Package(folder, (source, True) if source else None), 0, True
    paths = (Path(place, name) for place, _, files in walk(folder) for name in files)
    for path in paths:
        if time.monotonic() > until:
            yield Finding(str(folder), "scripts", UNCHECKED,
                          f"the time is over; {path.name} and those after it are not read")
            return
        if not os.path.isfile(path) or not FILE_NAME.fullmatch(path.name) or (  # a pipe blocks
                package.is_other(path)
                and not (_is_for_rosrun(path, package) and os.access(path, os.X_OK))):
            continue
        if path.suffix in SOURCES:
            found = list(transport_findings(path))
        elif path.name != "setup.py" and (has_interpreter(path) or is_python(path)):
            found = list(script_findings(path, package))
        else:
            continue
        yield from (each for each in found if each.status != SILENT)
        number += not any(each.status == SILENT for each in found)
        fine = fine and not any(each.status in (*SERIOUS, UNCHECKED) for each in found)
    if number and fine:
        yield Finding(where or str(folder), f"scripts and C++ files ({number})", WORKS)


def _is_for_rosrun(path: Path, package: Package) -> bool:
    return path.relative_to(package.folder).parts[0] in FOR_ROSRUN


def transport_findings(path: Path) -> Iterator[Finding]:
    """A finding for each `TransportHints("NAME")` for which no plugin is installed."""
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST)
    except OSError:  # a link to nowhere, such as Emacs's locks: no compiler reads it either
        return
    for found in HINTS.finditer(text):
        name = found[1].decode()
        package = TRANSPORTS.get(name)
        if package and not _is_here(package):
            line = text.count(b"\n", 0, found.start()) + 1
            yield Finding(str(path), f"line {line}", ABSENT, (
                f"image_transport has no plugin for {name} here, so the node ends with a "
                "TransportLoadException; Debian 13 has it, Debian 12 does not: subscribe to raw "
                "images (rosrun image_transport republish compressed in:=TOPIC raw out:=OTHER "
                "makes them of compressed ones)"))


def _is_here(package: str) -> bool:
    return package in rospkg.RosPack().list()


def script_findings(path: Path, package: Package | None = None) -> Iterator[Finding]:
    """Findings about a script: how it is started, and what Python says of it.

    `package`: that it is in, given by those who did not name the script itself; some findings may
    then be SILENT.
    """
    try:
        yield from list(_script_findings(path, package or Package(package_of(path)),
                                         named=package is None))
    except Exception as error:  # of one script, which must not end the others
        yield Finding(str(path), "file", UNCHECKED,
                      f"it could not be checked: {type(error).__name__}: {error}")


def _script_findings(path: Path, package: Package, named: bool) -> Iterator[Finding]:
    python = is_python(path) or (named and holds_python(path))
    script = read_script(path) if python else Script(path)
    # Whether others import it, which takes long to find out, matters only for those not named.
    starts = named and has_interpreter(path) and os.access(path, os.X_OK)
    program = starts or package.is_program(script)
    if (named or program) and not package.is_relayed(path):
        status = PROBLEM if package.is_one and program else ""
        if not status and named and not package.is_imported(path) and (
                has_interpreter(path)
                or (not package.is_one and python and path.parent.name in FOR_ROSRUN)):
            status = HINT
        yield from _start_findings(path, status, program and python)
    if not python:
        return
    if not path.stat().st_size and (named or program) and path.name != "__init__.py":
        yield problem(str(path), FIRST, "it is empty, so that nothing starts")
    modules = program or (named and not package.is_other(path))
    found = list(python_findings(script, package.source, modules))
    if found and not (named or program or _is_for_rosrun(path, package)
                      or package.is_imported(path, certainly=True)):
        found = [replace(each, status=SILENT) for each in found]
    yield from found


def holds_python(path: Path) -> bool:
    """Whether a file without suffix and first line is Python, which data may be read as, too."""
    if path.suffix or has_interpreter(path):
        return False
    tree = read_script(path).tree
    return tree is not None and any(isinstance(node, HOLDS_PYTHON) for node in ast.walk(tree))


def _start_findings(path: Path, unfound: str, for_python: bool) -> Iterator[Finding]:
    """A finding if the script's first line is wrong, and one if rosrun does not find it.

    `unfound`: the status of the latter; empty: rosrun is not meant to find it.
    """
    line, executable = first_line(path), os.access(path, os.X_OK)
    if unfound and (for_python or unfound == HINT) and not executable and not has_interpreter(path):
        yield Finding(str(path), FIRST, unfound, f"rosrun does not find it: chmod +x "
                      f"{shlex.quote(str(path))}, and write {PYTHON} as its first line")
        return
    if line and (why := _fault(line.removesuffix(b"\n"), path, for_python)):
        yield problem(str(path), FIRST, why)
    if unfound and not executable:
        yield Finding(str(path), FIRST, unfound, "it is not executable, so that rosrun and "
                      f"roslaunch do not find it; type: chmod +x {shlex.quote(str(path))}")


def package_of(path: Path) -> Path:
    """The folder of the package that a file is in, else its own."""
    return next((each for each in path.parents if (each / "package.xml").is_file()), path.parent)


def _fault(line: bytes, path: Path, started: bool) -> str:
    if line.startswith(BYTE_ORDER_MARK + b"#!"):
        command = rf"sed -i '1s/^\xEF\xBB\xBF//' {shlex.quote(str(path))}"
        return ("a byte order mark stands before #!, so that no interpreter is found; type: "
                f"{command}")
    if not line.startswith(b"#!"):
        return (f"it has no #!, so that rosrun starts it as a shell script; write {PYTHON} there"
                if started else "")
    if line.endswith(b"\r"):
        command = rf"sed -i 's/\r$//' {shlex.quote(str(path))}"
        return f"it ends as lines do on Windows, so that no interpreter is found; type: {command}"
    words = line[2:].decode("utf-8", "replace").split()
    name = words[0] if words else ""
    if Path(name).name == "env":
        name = next((word for word in words[1:] if not word.startswith("-") and "=" not in word),
                    "")
    if name and shutil.which(name):
        return ""
    return f"there is no {name or 'interpreter'!s} here" + (
        f"; write {PYTHON} there" if "python" in name else "")
