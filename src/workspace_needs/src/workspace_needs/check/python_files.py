"""What Python will say of a script: its syntax, the modules that it imports, old names in it."""

import ast
import collections.abc
import re
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy
from python_amendments.old_names import CV2_NAMES, NUMPY_BUILTINS, NUMPY_NAMES

from bullet_sim_ros.interface import APPROXIMATED
from workspace_needs.check.findings import ABSENT, UNCHECKED, Finding, problem
from workspace_needs.check.modules import why_no_import

CODING = re.compile(rb"^[ \t\f]*#.*coding[:=]", re.MULTILINE)  # PEP 263
LARGEST = 1 << 20  # bytes of a script that is read
OF_PYTHON_2 = re.compile("Missing parentheses in call|multiple exception types|leading zeros|"
                         "inconsistent use of tabs")
# Conditions of what may be for another Python, or for nobody here.
ANY = re.compile("^(?!.*__name__)", re.DOTALL)
OF_VERSIONS = re.compile("hasattr|version")
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
INIT_NODE = re.compile(rb"\binit_node\s*\(")
NEW_NAMES = {
    "numpy": {old: kind.__name__ for old, kind in NUMPY_BUILTINS.items()
              if old not in vars(numpy)}
             | {old: f"numpy.{new}" for old, new in NUMPY_NAMES.items()
                if old not in vars(numpy) and new in vars(numpy)},
    "cv2": {old: f"cv2.{new}" for old, new in CV2_NAMES.items()},
    "collections": {name: f"collections.abc.{name}" for name in collections.abc.__all__},
    "time": {"clock": "time.perf_counter"}}


@dataclass(frozen=True)
class Script:
    """A file of Python that was read."""

    path: Path
    text: bytes = b""
    tree: ast.Module | None = None  # None: Python cannot read it
    fault: Finding | None = None  # why

    @property
    def is_node(self) -> bool:
        """Whether it calls rospy.init_node."""
        if self.tree is None:
            return INIT_NODE.search(self.text) is not None
        return any(isinstance(node, ast.Call) and "init_node" in (
            getattr(node.func, "attr", ""), getattr(node.func, "id", ""))
            for node in ast.walk(self.tree))


def read_script(path: Path) -> Script:
    """Reads a file as Python does, without running it."""
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST + 1)
    except OSError as error:
        return Script(path, fault=problem(str(path), "file", error))
    if len(text) > LARGEST:
        return Script(path, fault=Finding(
            str(path), "file", UNCHECKED, "it is not read: it has more than 1 MiB"))
    try:
        return Script(path, text, _parsed(text, path))
    except UnicodeDecodeError as error:
        line = text.count(b"\n", 0, error.start) + 1
        why = "it is not UTF-8; save it as UTF-8"
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        said = getattr(error, "msg", None) or str(error) or type(error).__name__
        said = said.removeprefix("f-string: ")
        version = ("this is Python 2, and only Python 3 is here"
                   if OF_PYTHON_2.match(str(said)) else "Python 3 cannot read it")
        line = getattr(error, "lineno", None) or 1
        why = f"{version}: {said}; check it again once this is mended: what follows is not read"
    return Script(path, text, fault=problem(str(path), f"line {line}", why))


def python_findings(script: Script, folder: Path, modules: bool) -> Iterator[Finding]:
    """Findings about a script of the package in `folder`, as Python would meet them.

    `modules`: also about those that are absent.
    """
    if script.fault:
        yield script.fault
        return
    # Where else modules are is known once it runs.
    if modules and not re.search(rb"sys\.path|addsitedir", script.text):
        yield from _absent_modules(script.tree, script.path, folder)
    yield from _old_names(script.tree, script.path)


def _parsed(text: bytes, path: Path) -> ast.Module:
    if not CODING.search(b"".join(text.splitlines(True)[:2])):
        text.decode("utf-8")  # Python reads comments, too, which ast does not
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        tree = ast.parse(text, str(path))
        compile(tree, str(path), "exec")  # which alone finds a return outside of a function
    return tree


def imports(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, str, int]]:
    """Module, name in it or "", and line of each import; of `from .a import b` a and b."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from ((alias.name, "", node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from ((node.module or "", alias.name, node.lineno) for alias in node.names)


def at_import(tree: ast.Module) -> Iterator[ast.AST]:
    """What certainly runs when the file is started or imported."""
    return _certain(tree, ANY, FUNCTIONS)


def _absent_modules(tree: ast.Module, path: Path, folder: Path) -> Iterator[Finding]:
    """A finding for the first place of each that the script cannot do without."""
    places: dict[str, int] = {}
    nodes = (node for node in at_import(tree) if not getattr(node, "level", 0))
    for module, name, line in imports(nodes):
        places.setdefault(why_no_import(module, name, path, folder), line)
    places.pop("", None)
    for why, line in places.items():
        yield Finding(str(path), f"line {line}", ABSENT, why)


def _certain(tree: ast.Module, conditions: re.Pattern, without: tuple[type, ...] = ()
             ) -> Iterator[ast.AST]:
    """The parts in their order, without those that may be for another Python, or in `without`.

    The former stand in a try with handlers, in a with that suppresses errors, or behind such a
    condition.
    """
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        if not (isinstance(node, without) or (isinstance(node, ast.Try) and node.handlers)
                or (isinstance(node, ast.With) and "suppress" in ast.unparse(node.items[0]))
                or (isinstance(node, ast.If | ast.IfExp)
                    and conditions.search(ast.unparse(node.test)))):
            waiting += reversed(list(ast.iter_child_nodes(node)))


def _old_names(tree: ast.Module, path: Path) -> Iterator[Finding]:
    """A finding for the first place of each name that a library had and has here again."""
    nodes = list(_certain(tree, OF_VERSIONS))
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
