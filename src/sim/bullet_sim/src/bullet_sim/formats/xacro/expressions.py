"""xacro's `${…}` and `$(eval …)`: Python expressions, by an allow-list for Python's syntax tree.

A file's author may compute, but reach nothing else: no lambda, no assignment, and only the
attributes of values that are listed here. Names are those passed by xacro, without `vars`; `type`
takes one value.
"""

import ast
import functools
import string
from collections.abc import Callable, Mapping, Sequence
from types import CodeType
from typing import Any

import xacro

from bullet_sim.errors import FormatError

ALLOWED = (
    ast.Expression, ast.Constant, ast.Name, ast.Load, ast.Store, ast.Starred,
    ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp,
    ast.operator, ast.unaryop, ast.boolop, ast.cmpop,
    ast.List, ast.Tuple, ast.Dict, ast.Set, ast.Subscript, ast.Slice,
    ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.comprehension,
    ast.Call, ast.keyword, ast.Attribute, ast.JoinedStr, ast.FormattedValue,
)
_OF_SETS = "copy difference intersection isdisjoint issubset issuperset symmetric_difference union"
METHODS = {
    kind: frozenset(names.split()) for kind, names in {
        str: "capitalize casefold center count endswith find format index isalnum isalpha isascii "
             "isdecimal isdigit isidentifier islower isnumeric isprintable isspace istitle isupper "
             "join ljust lower lstrip partition removeprefix removesuffix replace rfind rindex "
             "rjust rpartition rsplit rstrip split splitlines startswith strip swapcase title "
             "upper zfill",
        dict: "copy get items keys pop setdefault update values",
        list: "append copy count extend index insert pop remove reverse sort",
        tuple: "count index",
        set: f"add discard remove {_OF_SETS}",
        frozenset: _OF_SETS,
        float: "is_integer",
        int: "bit_length",
        complex: "conjugate imag real",
    }.items()
}
_ATTRIBUTE = "<attribute>"  # a name that no file can write


def evaluate(expression: str, symbols: dict, local: Mapping | None = None) -> Any:
    """The value of an expression; replaces xacro's `safe_eval`, and in `$(eval …)` `eval`.

    FormatError names what is not allowed; else whatever the expression raises.
    """
    symbols.update(__builtins__=_BUILTINS)
    return eval(_compiled(expression.strip()), symbols, local)


def evaluate_substitution(expression: str, _symbols: dict, local: Mapping) -> Any:
    """Replaces `eval` in `$(eval …)` of xacro and of roslaunch: with the builtins of `${…}`.

    FormatError names what is not allowed; else whatever the expression raises.
    """
    return evaluate(expression, dict(_PYTHON), local)


def restricted(symbols: dict) -> dict:
    """xacro's symbols without those that lead out of an expression."""
    python = symbols["python"]
    del python["vars"]
    python["type"] = _type_of
    return symbols


@functools.lru_cache(maxsize=1024)  # a macro's expressions are evaluated again in each call
def _compiled(expression: str) -> CodeType:
    tree = ast.parse(expression, "<expression>", "eval")
    for node in ast.walk(tree):
        if not isinstance(node, ALLOWED):
            raise FormatError(f"{type(node).__name__} may not be used in an expression")
        name = getattr(node, "id", None) or getattr(node, "attr", "")
        if name.startswith("__"):
            raise FormatError(f"Use of invalid name(s): {name}")
    return compile(ast.fix_missing_locations(_Attributes().visit(tree)), "<expression>", "eval")


class _Attributes(ast.NodeTransformer):
    """Turns `value.name` into a call of `_attribute`."""

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        value = self.visit(node.value)
        return ast.copy_location(ast.Call(
            ast.Name(_ATTRIBUTE, ast.Load()), [value, ast.Constant(node.attr)], []), node)


def _attribute(value: Any, name: str) -> Any:
    """The value of `value.name`; FormatError if it is not allowed in expressions."""
    if isinstance(value, xacro.NameSpace):
        if name not in value:
            raise NameError(f"name '{name}' is not defined")
        return value[name]
    kinds = value.__mro__ if isinstance(value, type) else type(value).__mro__
    if any(name in METHODS.get(kind, ()) for kind in kinds):
        if name == "format":
            return _format if isinstance(value, type) else functools.partial(_format, value)
        return getattr(value, name)
    if isinstance(value, xacro.YamlDictWrapper) and not name.startswith("_"):
        return value[name]
    raise FormatError(
        f"Use of invalid name(s): {name} of a value of type {type(value).__name__}")


class _Formatter(string.Formatter):
    """`str.format` with only names and numbers as fields: `{0.real}` reaches attributes."""

    def get_field(self, field_name: str, args: Sequence, kwargs: Mapping) -> tuple[Any, Any]:
        if "." in field_name or "[" in field_name:
            raise FormatError(f"Use of invalid name(s): {field_name} in a format")
        return super().get_field(field_name, args, kwargs)


_format: Callable[..., str] = _Formatter().format


def _type_of(value: Any) -> type:
    if value is not None and not isinstance(value, tuple(METHODS)):
        raise FormatError(f"type() of a {type(value).__name__} may not be used")
    return type(value)


_BUILTINS = {_ATTRIBUTE: _attribute}
_PYTHON = dict(restricted(xacro.create_global_symbols())["python"])
