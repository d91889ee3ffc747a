"""A package's own programs: first lines of scripts, and image transports of C++ nodes."""

import os
import re
import shlex
import shutil
from collections.abc import Iterator
from pathlib import Path

import rospkg

from workspace_needs.check.findings import ABSENT, Finding, problem
from workspace_needs.workspace import SOURCES

LONGEST = 256  # bytes that Linux reads of a first line
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
PYTHON = "#!/usr/bin/env python3"
# With bounds, so that the time is linear.
HINTS = re.compile(rb"\bTransportHints\b[^;\n\"]{0,200}\(\s{0,200}\"(\w+)\"")
TRANSPORTS = {"compressed": "compressed_image_transport", "theora": "theora_image_transport",
              "compressedDepth": "compressed_depth_image_transport"}
LARGEST = 1 << 20  # bytes of a source that is searched


def program_findings(folder: Path) -> Iterator[Finding]:
    """A finding for each program below `folder` that will not start, or end with an exception.

    Scripts that CMakeLists.txt hands to catkin_install_python are started by catkin's relay.
    """
    cmake = folder / "CMakeLists.txt"
    text = cmake.read_text("utf-8", "replace") if cmake.is_file() else ""
    _, relayed, names = text.partition("catkin_install_python")
    for place, below, files in os.walk(folder):
        below[:] = sorted(name for name in below if not name.startswith("."))
        for path in (Path(place, name) for name in sorted(files)):
            if not path.is_file():  # a pipe, which nobody may write into
                continue
            if path.suffix in SOURCES:
                yield from transport_findings(path)
            elif os.access(path, os.X_OK) and not (relayed and path.name in names):
                yield from script_finding(path)


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
    try:
        rospkg.RosPack().get_path(package)
    except rospkg.ResourceNotFound:
        return False
    return True


def script_finding(path: Path) -> Iterator[Finding]:
    """A finding if the first line of the file is a script's and wrong."""
    try:
        with path.open("rb") as file:
            line, newline, _ = file.read(LONGEST).partition(b"\n")
    except OSError as error:
        yield problem(str(path), "line 1", error)
        return
    if newline and (why := _fault(line, path)):
        yield problem(str(path), "line 1", why)


def _is_script(path: Path) -> bool:
    """Whether it is no module: where all files are executable, as on Windows' disks, both are."""
    return (path.suffix == ".py" and path.name != "setup.py"
            and not (path.parent / "__init__.py").exists())


def _fault(line: bytes, path: Path) -> str:
    if line.startswith(BYTE_ORDER_MARK + b"#!"):
        command = rf"sed -i '1s/^\xEF\xBB\xBF//' {shlex.quote(str(path))}"
        return ("a byte order mark stands before #!, so that no interpreter is found; type: "
                f"{command}")
    if not line.startswith(b"#!"):
        return (f"it has no #!, so that rosrun starts it as a shell script; write {PYTHON} there"
                if _is_script(path) and not line.startswith(b"\x7fELF") else "")
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
