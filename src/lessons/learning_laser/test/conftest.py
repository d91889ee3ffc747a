"""The lesson as a module."""

import importlib.util
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(PACKAGE / "src"))


@pytest.fixture(scope="session")
def lesson():
    spec = importlib.util.spec_from_file_location(
        "avoid_obstacles", PACKAGE / "scripts" / "avoid_obstacles.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
