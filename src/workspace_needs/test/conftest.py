"""Lets the tests import what is beside them, and check files and packages."""

import sys
from pathlib import Path

import pytest
from workspace_needs.check.command import main

from bullet_sim_ros.plugins import register_plugins

sys.path.insert(0, str(Path(__file__).parent))
from workspaces import add_package

register_plugins()  # once, and not in the process of each file that a test checks


@pytest.fixture
def check(tmp_path, capsys):
    """Checks a text under a file name: exit code and what was printed."""
    def run(name: str, text: str, *arguments: str) -> tuple[int, str]:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        code = main([str(path), *arguments])
        return code, capsys.readouterr().out
    return run


@pytest.fixture
def package(tmp_path):
    """A package with files of these names and texts; its folder."""
    def make(**texts: str) -> str:
        if not (tmp_path / "CMakeLists.txt").exists():
            add_package(tmp_path.parent, tmp_path.name)
        for name, text in texts.items():
            (tmp_path / name.replace("__", ".")).write_text(text)
        return str(tmp_path)
    return make
