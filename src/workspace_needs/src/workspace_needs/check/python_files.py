"""What Python will say of a script: its syntax, the modules that it imports, old names in it."""

import ast
import collections.abc
import itertools
import os
import re
import sys
import warnings
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy
from headless_highgui.old_names import CV2_NAMES, NUMPY_BUILTINS, NUMPY_NAMES

from bullet_sim_ros.interface import APPROXIMATED
from workspace_needs.check.absent import tables
from workspace_needs.check.findings import ABSENT, Finding, problem
from workspace_needs.tables import ABSENT as ABSENT_HERE
from workspace_needs.tables import DEBIAN, OURS

NAME = re.compile(r"<name>\s*(\w+)\s*</name>")
CODING = re.compile(rb"^[ \t\f]*#.*coding[:=]", re.MULTILINE)  # PEP 263
LARGEST = 1 << 20  # bytes of a script that is read
OF_PYTHON_2 = re.compile("Missing parentheses in call|multiple exception types|leading zeros|"
                         "inconsistent use of tabs")
RENAMED = {"ConfigParser": "configparser", "Queue": "queue", "StringIO": "io",
           "Tkinter": "tkinter", "cPickle": "pickle", "commands": "subprocess",
           "thread": "_thread", "tkMessageBox": "tkinter.messagebox", "urllib2": "urllib.request",
           "urlparse": "urllib.parse"}
PACKAGES = {"Crypto": "python3-pycryptodome", "OpenGL": "python3-opengl", "PIL": "python3-pil",
            "bs4": "python3-bs4", "gi": "python3-gi", "paho": "python3-paho-mqtt",
            "pcl": "python3-pcl", "skimage": "python3-skimage", "sklearn": "python3-sklearn",
            "usb": "python3-usb", "wx": "python3-wxgtk4.0"}
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
    except UnicodeDecodeError as error:
        line = text.count(b"\n", 0, error.start) + 1
        yield problem(str(path), f"line {line}", "it is not UTF-8; save it as UTF-8")
        return
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        said = getattr(error, "msg", None) or str(error) or type(error).__name__
        version = ("this is Python 2, and only Python 3 is here"
                   if OF_PYTHON_2.match(str(said)) else "Python 3 cannot read it")
        line = getattr(error, "lineno", None) or 1
        yield problem(str(path), f"line {line}", f"{version}: {said}")
        return
    # Where else modules are is known once it runs; whoever runs tests has what these need.
    if not re.search(rb"sys\.path|addsitedir", text) and path.parent.name not in ("test", "tests"):
        yield from _absent_modules(tree, path, folder)
    yield from _old_names(tree, path)


def _parsed(text: bytes, path: Path) -> ast.Module:
    if not CODING.search(b"".join(text.splitlines(True)[:2])):
        text.decode("utf-8")  # Python reads comments, too, which ast does not
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
        yield Finding(str(path), f"line {line}", ABSENT,
                      f"module {name} is not here: {_why_no_module(name)}")


def _why_no_module(name: str) -> str:
    if name in RENAMED:
        return f"Python 3 calls it {RENAMED[name]}"
    package = PACKAGES.get(name, f"python3-{name.lower().replace('_', '-')}")
    if tables().answer(package).kind == DEBIAN:
        return f"sudo apt-get install {package}"
    answer = tables().answer(name)
    if answer.kind == ABSENT_HERE or "meant?" in answer.why:
        return answer.why
    return f"Debian has no {package}; put what brings it beside the script or into src/"


def _imported(tree: ast.Module) -> dict[str, int]:
    """The modules that the script cannot do without, each with its first line."""
    found: dict[str, int] = {}
    for node in _certain(tree, lambda node: isinstance(node, ast.If)
                         and "__name__" not in ast.unparse(node.test)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names = [node.module]
        else:
            names = []
        for name in names:
            found.setdefault(name.partition(".")[0], node.lineno)
    return found


def _certain(tree: ast.Module, may_not: Callable[[ast.AST], bool]) -> Iterator[ast.AST]:
    """The parts in their order, without those that may be for another Python.

    They stand in a try with handlers, in a with that suppresses errors, or where `may_not` says so.
    """
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        if not ((isinstance(node, ast.Try) and node.handlers) or may_not(node)
                or (isinstance(node, ast.With) and "suppress" in ast.unparse(node.items[0]))):
            waiting += reversed(list(ast.iter_child_nodes(node)))


def _workspace(folder: Path) -> tuple[Path, bool]:
    """Where the modules of a package may be, and whether its folders are looked through."""
    if not (folder / "package.xml").is_file():
        return folder, False
    return next((each for each in folder.parents if each.name == "src"), folder), True


@cache
def _names_below(folder: Path, deep: bool) -> frozenset[str]:
    """The names that modules and packages below a folder may have, also those made by a build."""
    found, seen = {folder.name}, set()
    walk = os.walk(folder, followlinks=True)
    for place, below, files in itertools.islice(walk, None if deep else 1):
        if os.path.realpath(place) in seen:  # a link to a folder above
            below.clear()
            continue
        seen.add(os.path.realpath(place))
        found |= {name.partition(".")[0] for name in (*below, *files)}
        if "package.xml" in files:
            found.update(NAME.findall(Path(place, "package.xml").read_text("utf-8", "replace")))
    return frozenset(found)


def _old_names(tree: ast.Module, path: Path) -> Iterator[Finding]:
    """A finding for the first place of each name that a library had and has here again."""
    nodes = list(_certain(tree, lambda node: isinstance(node, ast.If | ast.IfExp) and re.search(
        "hasattr|version", ast.unparse(node.test)) is not None))
    called = {alias.asname or alias.name: alias.name for node in nodes
              if isinstance(node, ast.Import) for alias in node.names}
    places: dict[tuple[str, str], int] = {}
    for node in nodes:
        if (isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
                and isinstance(node.ctx, ast.Load)):
            places.setdefault((called.get(node.value.id, ""), node.attr), node.lineno)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            for alias in node.names:
                places.setdefault((node.module, alias.name), node.lineno)
    for (module, old), line in places.items():
        if new := NEW_NAMES.get(module, {}).get(old):
            yield Finding(str(path), f"line {line}", APPROXIMATED,
                          f"{module}.{old} is an old name: write {new}")
