"""Which files of a package are programs, and which are modules that others need."""

import ast
import os
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import cache, cached_property
from pathlib import Path

from workspace_needs.check.modules import NAME, Source, source_of, text_of, walk
from workspace_needs.check.python_files import LARGEST, Script, at_import, imports, read_script

FOR_ROSRUN = ("scripts", "script", "nodes", "node", "bin")  # folders of a package
OTHERS = {"test", "tests", "doc", "docs", "template", "templates", "third_party", "examples"}
LONGEST = 256  # bytes that Linux reads of a first line
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
INSTALLS = r"\b{}\s*\(\s*PROGRAMS\b(.*?)(?:\bDESTINATION\b|\))"
WORD = re.compile(rb"[\w\x80-\xff]+")  # in any encoding
NODE = re.compile(r"<node\b[^>]*>")
ATTRIBUTE = r"\b{}\s*=\s*[\"']([^\"']*)"


class Package:
    """What matters of the package that a script is in; each file is read once.

    `source`: where its workspace's modules are, if that is known.
    """

    def __init__(self, folder: Path, source: Source | None = None):
        self.folder = folder
        self.source = source or source_of(folder)
        self.is_one = (folder / "package.xml").is_file()
        cmake = folder / "CMakeLists.txt"
        text = re.sub("#.*", "", text_of(cmake)) if cmake.is_file() else ""
        self._relayed, self._installed = (
            {word.strip('"').rpartition("/")[2]
             for call in re.findall(INSTALLS.format(command), text, re.IGNORECASE | re.DOTALL)
             for word in call.split()} for command in ("catkin_install_python", "install"))

    def is_relayed(self, path: Path) -> bool:
        """Whether catkin may start a script: CMakeLists.txt hands it to catkin_install_python."""
        return path.name in self._relayed or (
            path.suffix == ".py" and any("${" in name for name in self._relayed))

    def is_other(self, path: Path) -> bool:
        """Whether it is below a folder of what only makers use, or others made."""
        return not OTHERS.isdisjoint(path.relative_to(self.folder).parts[:-1])

    def is_program(self, script: Script) -> bool:
        """Whether rosrun or roslaunch is meant to start it: no module, even if all are executable,
        as on Windows' disks.
        """
        path = script.path
        if path.name in self._launched:
            return True
        *place, name = path.relative_to(self.folder).parts
        module = (path.parent / "__init__.py").exists() and "src" in place
        in_place = place in ([], ["src"]) or place[0] in FOR_ROSRUN
        return not module and (
            name in self._relayed or name in self._installed
            or (os.access(path, os.X_OK) and has_interpreter(path))
            or (self.is_one and in_place and script.is_node)
        ) and not self.is_imported(path)

    @cached_property
    def _launched(self) -> frozenset[str]:
        """The programs of this package that its own launch files start."""
        if not self.is_one:
            return frozenset()
        names = NAME.findall(text_of(self.folder / "package.xml"))
        nodes = [node for path in self.folder.rglob("*.launch") if path.is_file()
                 for node in NODE.findall(text_of(path))]
        return frozenset(kind for node in nodes for kind in _values("type", node)
                         if names[:1] == _values("pkg", node))

    def is_imported(self, path: Path, certainly: bool = False) -> bool:
        """Whether another file imports it; `certainly`: and not only perhaps."""
        name = path.parent.name if path.stem == "__init__" else path.stem
        return self.is_one and any(
            other != path and name in _imported(other)[certainly]
            for other in _naming(self.source[0]).get(name.encode(), ()))


def first_line(path: Path) -> bytes:
    """What Linux reads of a first line; nothing if that has no end or the file cannot be read."""
    try:
        with path.open("rb") as file:
            line, newline, _ = file.read(LONGEST).partition(b"\n")
    except OSError:
        return b""
    return line + newline if newline else b""


def has_interpreter(path: Path) -> bool:
    """Whether a script names one, if need be behind a byte order mark."""
    return first_line(path).removeprefix(BYTE_ORDER_MARK).startswith(b"#!")


def is_python(path: Path) -> bool:
    """Whether Python is to read a file: by its first line, else by its name."""
    if has_interpreter(path):
        return b"python" in first_line(path)
    return path.suffix == ".py"


@cache
def _naming(folder: Path) -> Mapping[bytes, list[Path]]:
    """For each word, the Python files that contain it."""
    found = defaultdict(list)
    for place, _, files in walk(folder):
        for path in (Path(place, name) for name in files):
            if path.suffix in (".py", "") and os.path.isfile(path) and is_python(path):
                with suppress(OSError), path.open("rb") as file:
                    for word in set(WORD.findall(file.read(LARGEST))):
                        found[word].append(path)
    return found


@cache
def _imported(path: Path) -> tuple[frozenset[str], frozenset[str]]:
    """Each part of the names that a file imports: all, and those that it cannot do without."""
    script = read_script(path)
    if script.tree is None:
        words = frozenset(re.findall(r"\w+", script.text.decode("utf-8", "replace")))
        return words, frozenset()
    return _words(ast.walk(script.tree)), _words(at_import(script.tree))


def _words(nodes: Iterable[ast.AST]) -> frozenset[str]:
    return frozenset(word for module, name, _ in imports(nodes)
                     for word in (*module.split("."), name))


def _values(attribute: str, node: str) -> list[str]:
    return re.findall(ATTRIBUTE.format(attribute), node)
