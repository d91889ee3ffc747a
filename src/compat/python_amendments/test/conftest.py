"""Lets pytest import the packages from their source folders; what a node says."""

import pathlib
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[1] / "src"
sys.path[:0] = [str(SOURCE), str(SOURCE.parents[2] / "interfaces/terminal_language/src"),
                str(SOURCE.parents[2] / "interfaces/node_basics/src")]


@pytest.fixture
def said(monkeypatch):
    """What the node logs."""
    import rospy
    from python_amendments import waiting

    lines = []
    monkeypatch.setattr(rospy, "logwarn", lambda form, *values: lines.append(form % values))
    monkeypatch.setattr(waiting, "SAID", set())
    monkeypatch.setattr(rospy, "is_shutdown", lambda: False)
    return lines
