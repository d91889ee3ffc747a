"""One warning per node that names parameters which are set but have no effect."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from typing import Any

import rospy

from nav_nodes.parameters import Parameter

Tables = Mapping[str, Iterable[Parameter]]  # by namespace below the node's: "", "a/b"


def below(name: str, tables: Tables) -> dict[str, Iterable[Parameter]]:
    """The tables with `name` prepended to their namespaces."""
    return {f"{name}/{space}".rstrip("/"): table for space, table in tables.items()}


def warn_of_ignored(tables: Tables, others: Iterable[str] = ()) -> None:
    """Checks the parameters below the node's name; `others` are allowed names without a table."""
    found = list(ignored(rospy.get_param("~", {}), tables, others))
    if found:
        rospy.logwarn("%s: parameters without effect: %s", rospy.get_name(), "; ".join(found))


def ignored(tree: Mapping[str, Any], tables: Tables, others: Iterable[str] = ()) -> Iterator[str]:
    """Yields each name in `tree` that no table reads, or that is read but has no effect.

    A namespace without a table belongs to a planner that is not in use, and is ignored, unless its
    name is similar to one in use.
    """
    known = {"": [], **tables}
    for space in list(tables):
        parts = space.split("/")
        for depth in range(1, len(parts)):
            known.setdefault("/".join(parts[:depth]), [])
    yield from _below(tree, "", known, set(others))


def _below(tree: Mapping[str, Any], space: str, tables: Tables, others: set[str]) -> Iterator[str]:
    entries = {name: entry for entry in tables[space] for name in (entry.name, *entry.also)}
    renamed = {name: entry.name for entry in tables[space] for name in entry.was}
    folders = [key.rpartition("/")[2] for key in tables if key and key.rpartition("/")[0] == space]
    for name, value in tree.items():
        path = f"{space}/{name}".lstrip("/")
        is_folder = isinstance(value, Mapping)
        if is_folder and path in tables:
            yield from _below(value, path, tables, others)
        elif name in entries:
            yield from _useless(path, value, entries[name])
        elif name in renamed:
            yield f"{path} (now {renamed[name]})"
        elif path not in others:
            near = get_close_matches(name, folders if is_folder else entries, 1, 0.75)
            if near or not is_folder:
                hint = f" (did you mean {near[0]}?)" if near else ""
                yield path + hint


def _useless(path: str, value: Any, entry: Parameter) -> Iterator[str]:
    """A line for a parameter without effect, unless it has its default value."""
    if entry.status != "works" and value != entry.default:
        what = "has another meaning: " if entry.status == "differs" else ""
        yield f"{path} ({what}{entry.meaning})"
