"""`$(…)` in xacro files: those that ROS 1's xacro supports and PyPI's does not."""

import itertools
import os
import re
import socket
from collections.abc import Callable
from typing import Any

import xacro
from xacro import substitution_args

_COUNT = itertools.count()
ANON = re.compile(r"\$\(anon\s+([^\s)]+)\s*\)")
# As xacro's own, but $(eval …) may contain calls such as arg('x'), nested up to three deep.
LEXER = xacro.QuickLexer(
    DOLLAR_DOLLAR_BRACE=r"^\$\$+(\{|\()",
    EXPR=r"^\$\{[^\}]*\}",
    EXTENSION=r"^\$\(eval\s(?:[^()]|\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\))*\)|^\$\([^\)]*\)",
    TEXT=r"[^$]+|\$[^{($]+|\$$",
)


class NoSuchArgument(substitution_args.ArgException, KeyError):
    """A KeyError where Python resolves a name; elsewhere xacro's own error."""

    __str__ = Exception.__str__


class Arguments(dict):
    """Values by name; access to a missing one raises the same error by item and by attribute."""

    def __missing__(self, name: str) -> str:
        raise NoSuchArgument(name)


def directory(_filename: str) -> str:
    """`$(dirname)`: the folder of the file being read."""
    return os.path.abspath(os.path.dirname(xacro.filestack[-1]))


def resolver(resolve: Callable[..., str]) -> Callable[..., str]:
    """PyPI's `resolve_args`, and also `$(anon NAME)`: one name per NAME and expansion."""
    names: dict[str, str] = {}

    def anonymous(match: re.Match) -> str:
        # The form of rosgraph's: name, host, process, and a number instead of its milliseconds.
        host = re.sub(r"\W", "_", socket.gethostname())
        made = f"{match[1]}_{host}_{os.getpid()}_{next(_COUNT)}"
        return names.setdefault(match[1], made)

    def resolve_args(text: str, context: Any = None, **options: Any) -> str:
        return resolve(ANON.sub(anonymous, text), context, **options)

    return resolve_args
