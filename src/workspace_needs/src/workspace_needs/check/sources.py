"""A package's own programs: its scripts, and image transports of C++ nodes."""

import os
import re
import shlex
import shutil
from collections.abc import Iterator
from contextlib import suppress
from functools import cached_property
from pathlib import Path

import rospkg

from workspace_needs.check.findings import ABSENT, Finding, problem
from workspace_needs.check.python_files import Script, python_findings, read_script
from workspace_needs.workspace import SOURCES

FOR_ROSRUN = ("scripts", "script", "nodes", "node", "bin")  # folders of a package
HOLDS_PYTHON = re.compile(rb"^(?:from|import|def|class)[ \t]+[\w.]+", re.MULTILINE)
IMPORTS = re.compile(r"^\s*(?:import|from)\s+(.+)$", re.MULTILINE)
LONGEST = 256  # bytes that Linux reads of a first line
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
PYTHON = "#!/usr/bin/env python3"
# With bounds, so that the time is linear.
HINTS = re.compile(rb"\bTransportHints\b[^;\n\"]{0,200}\(\s{0,200}\"(\w+)\"")
TRANSPORTS = {"compressed": "compressed_image_transport", "theora": "theora_image_transport",
              "compressedDepth": "compressed_depth_image_transport"}
LARGEST = 1 << 20  # bytes of a source that is searched


class Package:
    """What matters of the package that a script is in; each file is read once."""

    def __init__(self, folder: Path):
        self.folder = folder

    @cached_property
    def relayed(self) -> frozenset[str]:
        """The scripts that CMakeLists.txt hands to catkin_install_python: catkin starts them."""
        cmake = self.folder / "CMakeLists.txt"
        text = cmake.read_text("utf-8", "replace") if cmake.is_file() else ""
        calls = re.findall(r"catkin_install_python\s*\(([^)]*)\)", re.sub("#.*", "", text))
        return frozenset(word for call in calls for word in re.split(r'[\s/"]+', call))

    @cached_property
    def _imported(self) -> frozenset[str]:
        """Each word of the import lines of its Python files."""
        lines = (line for path in self.folder.rglob("*.py") if path.is_file()
                 for line in IMPORTS.findall(path.read_text("utf-8", "replace")))
        return frozenset(word for line in lines for word in re.findall(r"\w+", line))

    def is_script(self, path: Path) -> bool:
        """Whether it is no module: where all files are executable, as on Windows' disks, both are.
        """
        module = ((path.parent / "__init__.py").exists()
                  and "src" in path.relative_to(self.folder).parts)
        return is_python(path) and path.name not in ("setup.py", "__init__.py") and not module

    def is_for_rosrun(self, path: Path) -> bool:
        """Whether a script is meant to be started by its name, and nobody imports it."""
        if not (self.folder / "package.xml").is_file():
            return False
        place = path.relative_to(self.folder).parts[:-1]
        if not (place in ((), ("src",)) or place[0] in FOR_ROSRUN) or (
                path.suffix == ".py" and not self.is_script(path)):
            return False
        return path.stem not in self._imported


def program_findings(folder: Path) -> Iterator[Finding]:
    """Findings about programs below `folder` that will not start, or end with an exception.

    Also about modules that they may import; what these lack is named where it is met first.
    """
    package = Package(folder)
    absent: set[str] = set()
    for place, below, files in os.walk(folder):
        below[:] = sorted(name for name in below if not name.startswith(".")
                          and not os.path.exists(os.path.join(place, name, "pyvenv.cfg")))
        for path in (Path(place, name) for name in sorted(files)):
            if not path.is_file():  # a pipe, which nobody may write into
                continue
            if path.suffix in SOURCES:
                yield from transport_findings(path)
            elif path.name != "setup.py" and (  # which the build reads
                    path.suffix == ".py" or os.access(path, os.X_OK)
                    or path.name in package.relayed
                    or (_first_line(path).startswith(b"#!") and package.is_for_rosrun(path))):
                for found in script_findings(path, package):
                    if found.how not in absent or package.is_for_rosrun(path):
                        yield found
                    if found.status == ABSENT:
                        absent.add(found.how)


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


def script_findings(path: Path, package: Package | None = None) -> Iterator[Finding]:
    """Findings about a script: how it is started, and what Python says of it.

    `package`: that it is in, given by those who did not name the script itself.
    """
    named, package = package is None, package or Package(_package_of(path))
    script = read_script(path) if is_python(path) else Script(path)
    if path.name not in package.relayed:
        yield from _start_findings(script, package)
    if is_python(path):
        if not path.stat().st_size and package.is_script(path) and (
                named or os.access(path, os.X_OK) or path.name in package.relayed):
            yield problem(str(path), "line 1", "it is empty, so that nothing starts")
        yield from python_findings(script, package.folder)


def is_script(path: Path) -> bool:
    """Whether a file is a script, by its first line, its name, or the Python in it."""
    return _first_line(path).removeprefix(BYTE_ORDER_MARK).startswith(b"#!") or is_python(path)


def is_python(path: Path) -> bool:
    """Whether Python is to read a file."""
    line = _first_line(path).removeprefix(BYTE_ORDER_MARK)
    if line.startswith(b"#!"):
        return b"python" in line
    if path.suffix:
        return path.suffix == ".py"
    with suppress(OSError), path.open("rb") as file:
        text = file.read(LARGEST)
        return b"\0" not in text and HOLDS_PYTHON.search(text) is not None
    return False


def _start_findings(script: Script, package: Package) -> Iterator[Finding]:
    """A finding if the script's first line is wrong, and one if rosrun does not find it."""
    path, line = script.path, _first_line(script.path)
    executable = os.access(path, os.X_OK)
    for_rosrun = ((line.startswith(b"#!") or script.is_program) and package.is_for_rosrun(path))
    started = for_rosrun or (executable and package.is_script(path))
    if line and (why := _fault(line.removesuffix(b"\n"), path, started)):
        yield problem(str(path), "line 1", why)
    if for_rosrun and not executable:
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
