"""What Python will say of a script: its syntax, and the modules that it imports."""

import ast
import re
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from workspace_needs.check.findings import ABSENT, UNCHECKED, Finding, problem
from workspace_needs.check.modules import Source, why_no_import

CODING = re.compile(rb"^[ \t\f]*#.*coding[:=]", re.MULTILINE)  # PEP 263
LARGEST = 1 << 20  # bytes of a script that is read
OF_PYTHON_2 = re.compile("Missing parentheses in call|multiple exception types|leading zeros|"
                         "inconsistent use of tabs")
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
INIT_NODE = re.compile(rb"\binit_node\s*\(")


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


def python_findings(script: Script, source: Source, modules: bool) -> Iterator[Finding]:
    """Findings about a script, as Python would meet them.

    `source`: where its package's modules are. `modules`: also about those that are absent.
    """
    if script.fault:
        yield script.fault
        return
    # Where else modules are is known once it runs.
    if not modules or re.search(rb"sys\.path|addsitedir", script.text):
        return
    places: dict[str, int] = {}  # the first of each
    nodes = (node for node in at_import(script.tree) if not getattr(node, "level", 0))
    for module, name, line in imports(nodes):
        places.setdefault(why_no_import(module, name, script.path, source), line)
    places.pop("", None)
    for why, line in places.items():
        yield Finding(str(script.path), f"line {line}", ABSENT, why)


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
    """What certainly runs when the file is started or imported, in its order.

    What may be for another Python stands in a try with handlers, in a with that suppresses errors,
    or behind a condition, other than of __name__.
    """
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        if not (isinstance(node, FUNCTIONS) or (isinstance(node, ast.Try) and node.handlers)
                or (isinstance(node, ast.With) and "suppress" in ast.unparse(node.items[0]))
                or (isinstance(node, ast.If | ast.IfExp)
                    and "__name__" not in ast.unparse(node.test))):
            waiting += reversed(list(ast.iter_child_nodes(node)))
