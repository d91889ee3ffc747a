"""Public functions name the errors that they raise themselves, and rules name their source."""

import ast
import re
from functools import cache
from pathlib import Path

import bullet_sim.errors

CORE = Path(bullet_sim.errors.__file__).parent
Function = ast.FunctionDef | ast.AsyncFunctionDef
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


@cache
def modules() -> dict[Path, ast.Module]:
    return {path: ast.parse(path.read_text(encoding="utf-8"))
            for path in sorted(CORE.rglob("*.py"))}


@cache
def errors() -> frozenset[str]:
    """Names of SimulationError and of all that derive from it."""
    classes = [node for tree in modules().values() for node in ast.walk(tree)
               if isinstance(node, ast.ClassDef)]
    known, before = {"SimulationError"}, set()
    while known != before:
        before = set(known)
        known |= {node.name for node in classes
                  if any(isinstance(base, ast.Name) and base.id in known for base in node.bases)}
    return frozenset(known)


def raised(function: Function, private: dict[str, Function]) -> set[str]:
    """Our errors that leave a function, by itself or by private functions of its file it calls."""
    found, seen, waiting = set(), set(), [function]
    while waiting:
        function = waiting.pop()
        seen.add(function.name)
        for node in leaving(function):
            if isinstance(node, ast.Raise):
                found |= names_of(node.exc) & errors()
            elif isinstance(node, ast.Call):
                called = name_of(node.func)
                if called in private and called not in seen:
                    waiting.append(private[called])
    return found


def leaving(function: Function):
    """Nodes of a function but those in a `try` that catches one of our errors."""
    waiting = list(function.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Try) and any(
                {"SimulationError", "Exception", *errors()} & names_of(handler.type)
                for handler in node.handlers):
            waiting += [*node.handlers, *node.orelse, *node.finalbody]
            continue
        yield node
        waiting += ast.iter_child_nodes(node)


def names_of(node: ast.AST | None) -> set[str]:
    return set() if node is None else {
        each.id for each in ast.walk(node) if isinstance(each, ast.Name)}


def name_of(node: ast.AST) -> str:
    """`f` of f(...) and self.f(...)."""
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and (
            node.value.id == "self"):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def undocumented(tree: ast.Module) -> list[str]:
    private = {node.name: node for node in ast.walk(tree)
               if isinstance(node, FUNCTIONS) and node.name.startswith("_")}
    lines = []
    for owner in [tree, *(node for node in tree.body if isinstance(node, ast.ClassDef))]:
        if owner is not tree and owner.name.startswith("_"):
            continue
        for node in owner.body:
            if isinstance(node, FUNCTIONS) and (
                    not node.name.startswith("_") or node.name == "__init__"):
                text = ast.get_docstring(node) or ""
                if node.name == "__init__":
                    text += ast.get_docstring(owner) or ""
                missing = sorted(name for name in raised(node, private) if name not in text)
                if missing:
                    lines.append(f"{node.lineno}: {node.name} raises {', '.join(missing)}")
    return lines


def test_public_functions_name_the_errors_that_they_raise():
    silent = [f"{path.relative_to(CORE)}:{line}"
              for path, tree in modules().items() for line in undocumented(tree)]
    assert not silent, "the docstring does not say so:\n" + "\n".join(silent)


def test_the_check_sees_a_function_that_is_silent():
    tree = ast.parse('def f():\n    """Nothing."""\n    _g()\n'
                     "def _g():\n    raise FormatError('no')\n"
                     "def h():\n    try:\n        _g()\n    except FormatError:\n        pass\n")
    assert undocumented(tree) == ["1: f raises FormatError"]


def test_no_rule_is_as_upstream_without_a_place():
    vague = re.compile(r"\b[Uu]pstream(?!'s? [\w/ ]*\.(cpp|cc|hh|h|py)\b)")
    found = [f"{path.relative_to(CORE)}:{number}: {line.strip()}" for path in modules()
             for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
             if vague.search(line)]
    assert not found, "name the file and function:\n" + "\n".join(found)
