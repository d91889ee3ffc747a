"""The parameter server: all parameters, and setting or deleting one."""

import xmlrpc.client
from collections.abc import Callable
from typing import Any

import rosgraph
import yaml

from sim_viewer.registry import Refused, operation
from sim_viewer.tools.master import asked, connect
from sim_viewer.tools.messages import load_yaml

MOST_SHOWN = 200  # letters in the list; all of them when one parameter is opened
MOST_OPENED = 200_000
INTEGERS = range(-(1 << 31), 1 << 31)  # what XML-RPC carries


@operation("parameters")
async def parameters(context: Any) -> list[dict[str, Any]]:
    """`[{name, type, value, cut}]` by name; `value` is YAML text, cut if it is long."""
    return await context.run_in_thread(lambda: rows(master_call(lambda m: m.getParam("/"))))


@operation("parameter")
async def parameter(context: Any, name: str) -> dict[str, Any]:
    """One parameter in full.

    Refused for an invalid name, and if the master is gone.
    """
    check_name(name)
    value = await context.run_in_thread(master_call, lambda m: m.getParam(name))
    return row(name, value, MOST_OPENED)


@operation("set_parameter", control=True)
async def set_parameter(context: Any, name: str, value: str) -> dict[str, Any]:
    """Set a parameter from YAML text, and answer with its row as the server has it now.

    Refused for an invalid name or value, and if the master is gone.
    """
    check_name(name)
    parsed = await context.run_in_thread(read_value, value)
    await context.run_in_thread(master_call, lambda m: m.setParam(name, parsed))
    return await parameter(context, name)


@operation("delete_parameter", control=True)
async def delete_parameter(context: Any, name: str) -> None:
    """Delete a parameter and everything below it.

    Refused for an invalid name, and if the master is gone.
    """
    check_name(name)
    await context.run_in_thread(master_call, lambda m: m.deleteParam(name))


def rows(tree: Any, path: str = "") -> list[dict[str, Any]]:
    """The leaves of a tree of parameters by full name; an empty branch is a leaf."""
    if isinstance(tree, dict) and (tree or path):
        found = [row_ for key in sorted(tree) for row_ in rows(tree[key], f"{path}/{key}")]
        return found or [row(path, {}, MOST_SHOWN)]
    return [row(path, tree, MOST_SHOWN)] if path else []


def row(name: str, value: Any, most: int) -> dict[str, Any]:
    """One parameter for the page."""
    text = to_yaml(value, in_lines=most > MOST_SHOWN)
    return {"name": name, "type": type(value).__name__, "value": text[:most],
            "cut": len(text) > most}


def to_yaml(value: Any, in_lines: bool = True) -> str:
    """On one line, except texts of several lines; Python's repr if YAML cannot express it."""
    if isinstance(value, str) and "\n" in value and in_lines:
        return yaml.dump(value, default_style="|", allow_unicode=True)
    if isinstance(value, str) and "\n" in value:
        return yaml.dump(value, default_style='"', allow_unicode=True, width=1 << 30).rstrip()
    try:
        text = yaml.safe_dump(value, default_flow_style=True, allow_unicode=True, width=1 << 30)
    except yaml.YAMLError:
        return repr(value)
    return text.removesuffix("...\n").rstrip("\n")


def read_value(text: str) -> Any:
    """YAML text as a parameter's value; Refused if the server could not keep it."""
    value = load_yaml(text)
    _check_value(value)
    return value


def _check_value(value: Any) -> None:
    if isinstance(value, dict):
        for key, below in value.items():
            if not isinstance(key, str) or not rosgraph.names.is_legal_name(key):
                raise Refused(f"{key!r:.40} is not the name of a parameter")
            _check_value(below)
    elif isinstance(value, list):
        for one in value:
            _check_value(one)
    elif isinstance(value, str):
        if any(ord(c) < 32 and c not in "\t\n\r" for c in value):
            raise Refused("control characters cannot be kept in a parameter")
    elif isinstance(value, int):
        if value not in INTEGERS and not isinstance(value, bool):
            raise Refused(f"{value!r:.30} does not fit into the 32 bits of a parameter; "
                          "write it with a point")
    elif not isinstance(value, float):
        raise Refused("a parameter cannot be empty or a date; "
                      "write '' for an empty text, quotes around a date")


def check_name(name: str) -> None:
    """Refused unless it is a full name of one parameter."""
    if not name.startswith("/") or name == "/" or not rosgraph.names.is_legal_name(name):
        raise Refused(f"{name!r:.60} is not a full name of a parameter; begin with a slash")


def master_call(ask: Callable[[rosgraph.Master], Any]) -> Any:
    """The answer of the master; Refused says in one line why there is none."""
    try:
        return asked(lambda: ask(connect()))
    except (xmlrpc.client.Error, OverflowError, TypeError) as error:
        raise Refused(f"the ROS master refused: {error}") from None
