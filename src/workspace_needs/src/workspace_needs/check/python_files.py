"""What Python will say of a script: its syntax, the modules that it imports, old names in it."""

import ast
import collections.abc
import itertools
import os
import re
import sys
import warnings
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy
from headless_highgui.old_names import CV2_NAMES, NUMPY_BUILTINS, NUMPY_NAMES

from bullet_sim_ros.interface import APPROXIMATED
from workspace_needs.check.absent import tables, why_absent
from workspace_needs.check.findings import ABSENT, Finding, problem
from workspace_needs.tables import OURS

NAME = re.compile(r"<name>\s*(\w+)\s*</name>")
LARGEST = 1 << 20  # bytes of a script that is read
OF_PYTHON_2 = re.compile("Missing parentheses in call|multiple exception types|leading zeros|"
                         "inconsistent use of tabs")
RENAMED = {"ConfigParser": "configparser", "Queue": "queue", "StringIO": "io",
           "Tkinter": "tkinter", "cPickle": "pickle", "commands": "subprocess",
           "thread": "_thread", "tkMessageBox": "tkinter.messagebox", "urllib2": "urllib.request",
           "urlparse": "urllib.parse"}
NEW_NAMES = {
    "numpy": {old: kind.__name__ for old, kind in NUMPY_BUILTINS.items()
              if old not in vars(numpy)}
             | {old: f"numpy.{new}" for old, new in NUMPY_NAMES.items()
                if old not in vars(numpy) and new in vars(numpy)},
    "cv2": {old: f"cv2.{new}" for old, new in CV2_NAMES.items()},
    "collections": {name: f"collections.abc.{name}" for name in collections.abc.__all__},
    "time": {"clock": "time.perf_counter"}}


def python_findings(path: Path, folder: Path) -> Iterator[Finding]:
    """Findings about a script of the package in `folder`, as Python would meet them."""
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST + 1)
    except OSError as error:
        yield problem(str(path), "file", error)
        return
    if len(text) > LARGEST:
        return
    try:
        tree = _parsed(text, path)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        said = getattr(error, "msg", None) or error
        version = ("this is Python 2, and only Python 3 is here"
                   if OF_PYTHON_2.match(str(said)) else "Python 3 cannot read it")
        line = getattr(error, "lineno", None) or 1
        yield problem(str(path), f"line {line}", f"{version}: {said}")
        return
    # Where else modules are is known once it runs; whoever runs tests has what these need.
    if b"sys.path" not in text and path.parent.name not in ("test", "tests"):
        yield from _absent_modules(tree, path, folder)
    yield from _old_names(tree, path)


def _parsed(text: bytes, path: Path) -> ast.Module:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        tree = ast.parse(text, str(path))
        compile(tree, str(path), "exec")  # which alone finds a return outside of a function
    return tree


def _absent_modules(tree: ast.Module, path: Path, folder: Path) -> Iterator[Finding]:
    for name, line in _imported(tree).items():
        if (name in sys.stdlib_module_names or name in sys.modules or find_spec(name)
                or name in _names_below(path.parent, False)
                or name in _names_below(*_workspace(folder)) or tables().answer(name).kind == OURS):
            continue
        why = (f"Python 3 calls it {RENAMED[name]}" if name in RENAMED else
               why_absent(name, f"python3-{name.lower().replace('_', '-')}"))
        yield Finding(str(path), f"line {line}", ABSENT, f"module {name} is not here: {why}")


def _imported(tree: ast.Module) -> dict[str, int]:
    """The modules that the script cannot do without, each with its first line.

    What stands in a try or an if may be there for another Python.
    """
    found: dict[str, int] = {}
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names = [node.module]
        else:
            names = []
        for name in names:
            found.setdefault(name.partition(".")[0], node.lineno)
        if not isinstance(node, ast.Try | ast.If):
            waiting += reversed(list(ast.iter_child_nodes(node)))
    return found


def _workspace(folder: Path) -> tuple[Path, bool]:
    """Where the modules of a package may be, and whether its folders are looked through."""
    if not (folder / "package.xml").is_file():
        return folder, False
    return next((each for each in folder.parents if each.name == "src"), folder), True


@cache
def _names_below(folder: Path, deep: bool) -> frozenset[str]:
    """The names that modules and packages below a folder may have, also those made by a build."""
    found = {folder.name}
    for place, below, files in itertools.islice(os.walk(folder), None if deep else 1):
        found |= {name.partition(".")[0] for name in (*below, *files)}
        if "package.xml" in files:
            found.update(NAME.findall(Path(place, "package.xml").read_text("utf-8", "replace")))
    return frozenset(found)


def _old_names(tree: ast.Module, path: Path) -> Iterator[Finding]:
    """A finding for the first place of each name that a library had and has here again."""
    called = {alias.asname or alias.name: alias.name for node in ast.walk(tree)
              if isinstance(node, ast.Import) for alias in node.names}
    places: dict[tuple[str, str], int] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            places.setdefault((called.get(node.value.id, ""), node.attr), node.lineno)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            for alias in node.names:
                places.setdefault((node.module, alias.name), node.lineno)
    for (module, old), line in places.items():
        if new := NEW_NAMES.get(module, {}).get(old):
            yield Finding(str(path), f"line {line}", APPROXIMATED,
                          f"{module}.{old} is an old name: write {new}")
