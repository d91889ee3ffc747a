"""A package's own programs: its scripts, and image transports of C++ nodes."""

import os
import re
import shlex
import shutil
from collections.abc import Iterator
from pathlib import Path

import rospkg

from workspace_needs.check.findings import ABSENT, Finding, problem
from workspace_needs.check.python_files import python_findings
from workspace_needs.workspace import SOURCES

IMPORTS = re.compile(r"^\s*(?:import|from)\s+(.+)$", re.MULTILINE)
LONGEST = 256  # bytes that Linux reads of a first line
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
PYTHON = "#!/usr/bin/env python3"
# With bounds, so that the time is linear.
HINTS = re.compile(rb"\bTransportHints\b[^;\n\"]{0,200}\(\s{0,200}\"(\w+)\"")
TRANSPORTS = {"compressed": "compressed_image_transport", "theora": "theora_image_transport",
              "compressedDepth": "compressed_depth_image_transport"}
LARGEST = 1 << 20  # bytes of a source that is searched


def program_findings(folder: Path) -> Iterator[Finding]:
    """A finding for each program below `folder` that will not start, or end with an exception."""
    for place, below, files in os.walk(folder):
        below[:] = sorted(name for name in below if not name.startswith("."))
        for path in (Path(place, name) for name in sorted(files)):
            if not path.is_file():  # a pipe, which nobody may write into
                continue
            if path.suffix in SOURCES:
                yield from transport_findings(path)
            elif (os.access(path, os.X_OK) or _is_relayed(path, folder)
                  or (_first_line(path).startswith(b"#!") and _is_for_rosrun(path, folder))):
                yield from script_findings(path, folder)


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


def script_findings(path: Path, folder: Path | None = None) -> Iterator[Finding]:
    """Findings about a script: how it is started, and what Python says of it.

    `folder`: its package's, which is looked for unless it is given.
    """
    folder = folder or _package_of(path)
    yield from script_finding(path, folder)
    line = _first_line(path)
    if b"python" in line if line.startswith(b"#!") else path.suffix == ".py":
        if _is_script(path, folder) and not path.stat().st_size:
            yield problem(str(path), "line 1", "it is empty, so that nothing starts")
        yield from python_findings(path, folder)


def script_finding(path: Path, folder: Path | None = None) -> Iterator[Finding]:
    """A finding if the script's first line is wrong, or rosrun does not find it.

    Scripts that CMakeLists.txt hands to catkin_install_python are started by catkin's relay.
    """
    folder = folder or _package_of(path)
    if _is_relayed(path, folder):
        return
    line = _first_line(path)
    if line and (why := _fault(line.removesuffix(b"\n"), path, folder)):
        yield problem(str(path), "line 1", why)
    if line.startswith(b"#!") and not os.access(path, os.X_OK) and _is_for_rosrun(path, folder):
        yield problem(str(path), "line 1", "it is not executable, so that rosrun and roslaunch do "
                      f"not find it; type: chmod +x {shlex.quote(str(path))}")


def _first_line(path: Path) -> bytes:
    """What Linux reads of a first line; nothing if that has no end or the file cannot be read."""
    try:
        with path.open("rb") as file:
            line, newline, _ = file.read(LONGEST).partition(b"\n")
    except OSError:
        return b""
    return line + newline if newline else b""


def _package_of(path: Path) -> Path:
    """The folder of the package that a file is in, else its own."""
    return next((each for each in path.parents if (each / "package.xml").is_file()), path.parent)


def _is_relayed(path: Path, folder: Path) -> bool:
    """Whether the package's CMakeLists.txt hands a script to catkin_install_python."""
    cmake = folder / "CMakeLists.txt"
    text = cmake.read_text("utf-8", "replace") if cmake.is_file() else ""
    calls = re.findall(r"catkin_install_python\s*\(([^)]*)\)", re.sub("#.*", "", text))
    return any(path.name in re.split(r'[\s/"]+', call) for call in calls)


def _is_script(path: Path, folder: Path) -> bool:
    """Whether it is no module: where all files are executable, as on Windows' disks, both are."""
    module = ((path.parent / "__init__.py").exists()
              and "src" in path.relative_to(folder).parts)
    return path.suffix == ".py" and path.name not in ("setup.py", "__init__.py") and not module


def _is_for_rosrun(path: Path, folder: Path) -> bool:
    """Whether a package's script is meant to be started by its name, and nobody imports it."""
    if not (folder / "package.xml").is_file():
        return False
    place = path.relative_to(folder).parts[:-1]
    if not (place in ((), ("src",)) or place[0] in ("scripts", "nodes")) or (
            path.suffix == ".py" and not _is_script(path, folder)):
        return False
    return path.stem not in _imported_in(folder)


def _imported_in(folder: Path) -> frozenset[str]:
    """Each word of the import lines of a package's Python files."""
    lines = (line for path in folder.rglob("*.py") if path.is_file()
             for line in IMPORTS.findall(path.read_text("utf-8", "replace")))
    return frozenset(word for line in lines for word in re.findall(r"\w+", line))


def _fault(line: bytes, path: Path, folder: Path) -> str:
    if line.startswith(BYTE_ORDER_MARK + b"#!"):
        command = rf"sed -i '1s/^\xEF\xBB\xBF//' {shlex.quote(str(path))}"
        return ("a byte order mark stands before #!, so that no interpreter is found; type: "
                f"{command}")
    if not line.startswith(b"#!"):
        return (f"it has no #!, so that rosrun starts it as a shell script; write {PYTHON} there"
                if os.access(path, os.X_OK) and _is_script(path, folder) else "")
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
