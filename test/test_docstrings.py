"""Public functions name the errors that they raise, themselves or by private ones of their file."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

SIM = Path(__file__).resolve().parent.parent / "src/sim"
PACKAGES = ("bullet_sim_ros", "sim_viewer")  # bullet_sim has a stricter test of its own
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
Function = ast.FunctionDef | ast.AsyncFunctionDef


def leaving(function: Function) -> Iterator[ast.AST]:
    """Nodes of a function but those in a `try`, and those of functions made inside of it."""
    waiting = list(function.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Try):
            waiting += [*node.handlers, *node.orelse, *node.finalbody]
        elif not isinstance(node, (*FUNCTIONS, ast.Lambda)):
            yield node
            waiting += ast.iter_child_nodes(node)


def raised(function: Function, private: dict[str, Function]) -> set[str]:
    """Class names of the errors."""
    found, seen, waiting = set(), set(), [function]
    while waiting:
        function = waiting.pop()
        seen.add(function.name)
        for node in leaving(function):
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
                found.add(ast.unparse(node.exc.func).rpartition(".")[2])
            elif isinstance(node, ast.Call):
                called = ast.unparse(node.func).removeprefix("self.")
                if called in private.keys() - seen:
                    waiting.append(private[called])
    return {name for name in found if name[0].isupper()}


def silent(tree: ast.Module) -> list[str]:
    """What should name its errors, and does not."""
    private = {node.name: node for node in ast.walk(tree)
               if isinstance(node, FUNCTIONS) and node.name.startswith("_")}
    lines = []
    for owner in [tree, *(node for node in tree.body if isinstance(node, ast.ClassDef))]:
        for node in owner.body:
            if not isinstance(node, FUNCTIONS):
                continue
            # What is registered, as by @plugin(...), may raise PluginError when made: said there.
            made = node.name == "__init__" and not owner.decorator_list
            if made or not node.name.startswith("_"):
                doc = ast.get_docstring(node) or ""
                said = doc + (ast.get_docstring(owner) or "") if made else doc
                missing = sorted(name for name in raised(node, private) if name not in said)
                lines += [f"{node.lineno}: {node.name} raises {name}" for name in missing]
    return lines


@pytest.mark.parametrize("package", PACKAGES)
def test_public_functions_name_the_errors_that_they_raise(package: str):
    folder = SIM / package / "src" / package
    found = [f"{path.relative_to(folder)}:{line}" for path in sorted(folder.rglob("*.py"))
             for line in silent(ast.parse(path.read_text(encoding="utf-8")))]
    assert not found, "\n".join(found)


def test_the_rule_sees_a_function_that_is_silent():
    tree = ast.parse('def f():\n    """Nothing."""\n    _g()\n'
                     "def _g():\n    raise FormatError('no')\n"
                     "def h():\n    try:\n        _g()\n    except FormatError:\n        pass\n")
    assert silent(tree) == ["1: f raises FormatError"]
